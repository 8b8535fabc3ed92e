cdef int UNKNOWN, STUCK, SLIPPING, OPEN

cdef class SlipLimits:
    cdef double n0, b, sin_phi, cos_phi
    cdef double ell_1, ell_2, sin_P, cos_P, sin_N, cos_N, lower_P, upper_N
    cdef int behaviour(self, double n0_bar, double b_bar, double phi) noexcept nogil
    cdef double stuck_force(self) noexcept nogil
    cdef void _limits(self, double phi) noexcept nogil
