from fcm.contact.closed_form cimport ClosedForm
from fcm.contact.coefficient_law cimport CoefficientLaw
from fcm.table.cubic cimport Cubic
from fcm.table.locate cimport Place

cdef class Frame:
    cdef const double[:, ::1] low, high, here
    cdef bint within(self, Place place) noexcept nogil

cdef class Tabulated(CoefficientLaw):
    cdef Cubic cubic
    cdef Place place
    cdef Frame frame
    cdef ClosedForm exact
    cdef readonly long long outside
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
    cdef void _chain(self, double[::1] out, Py_ssize_t at) noexcept nogil
