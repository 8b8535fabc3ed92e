from fcm.time_domain.segment_walk cimport Walk

cdef class Powers(Walk):
    cdef readonly double work, slip, damping, turnover
    cdef readonly double[::1] slips, paths
    cdef bint _everywhere
    cdef double[:, ::1] _y, _terms, _wave
    cdef double[::1] _static, _damper, _nodes, _weights
    cdef void _add(self, double weight) noexcept nogil
