from fcm.contact.periodic.slider cimport Slider

cdef int STUCK
cdef double TWO_PI

cdef class Cycle(Slider):
    cdef readonly double overlap, greatest_lower, least_upper
    cdef int[::1] order
    cdef int solve(self, int behaviour, double start) noexcept nogil
    cdef bint far_inside(self, double start) noexcept nogil
    cdef void sort_cuts(self) noexcept nogil
    cdef int never_open(self, double start) noexcept nogil
    cdef void march(self, int first, int kind) noexcept nogil
