from fcm.time_domain.segment_walk cimport Walk

cdef class Powers(Walk):
    cdef readonly double work, slip, damping, turnover
    cdef readonly double[::1] slips, paths
    cdef bint _everywhere
    cdef double[:, ::1] _y, _terms, _wave
    cdef double[::1] _static, _damper, _nodes, _weights
    cdef void _add(self, double weight) noexcept nogil

cdef class Integrals(Walk):
    cdef readonly double[:, ::1] sums
    cdef double[::1] _nodes
    cdef double[:, ::1] _shares, _weights, _terms, _there, _sums
    cdef int _steps(self, Py_ssize_t slot, long long whole) except -1 nogil
    cdef void _gather(self, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void _weigh(self, double angle) noexcept nogil
    cdef void _take(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double h, int end, double one, double sine, double cosine) noexcept nogil
