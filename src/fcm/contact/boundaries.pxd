from fcm.contact.cycle cimport Cycle
from fcm.contact.law cimport Law

cdef class Boundaries(Law):
    cdef Cycle cycle
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
