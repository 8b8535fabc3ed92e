from fcm.contact.cycle cimport Cycle
from fcm.contact.coefficient_law cimport CoefficientLaw

cdef class Boundaries(CoefficientLaw):
    cdef Cycle cycle
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
