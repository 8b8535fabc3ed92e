from fcm.contact.periodic.slider cimport Slider

cdef int STUCK
cdef double TWO_PI

cdef class Cycle(Slider):
    cdef readonly double overlap, greatest_lower, least_upper
    cdef readonly int behaviour, kind
    cdef readonly double start
    cdef double[::1] numbers, law
    cdef int[::1] order
    cdef int take(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0, double start) noexcept nogil
    cdef bint known(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0, double start) noexcept nogil
    cdef int solve(self, int behaviour, double start) noexcept nogil
    cdef bint far_inside(self, double start) noexcept nogil
    cdef void sort_cuts(self) noexcept nogil
    cdef int never_open(self, double start) noexcept nogil
    cdef void march(self, int first, int kind) noexcept nogil
