from fcm.contact.coefficient_law cimport CoefficientLaw
from fcm.contact.slip_limits cimport SlipLimits

cdef class Boundaries(CoefficientLaw):
    cdef SlipLimits limits
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
