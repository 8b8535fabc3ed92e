from fcm.motion.steps cimport Steps

cdef class Powers:
    cdef readonly Steps steps
    cdef readonly double work, slip, damping, turnover
    cdef double[:, ::1] _y
    cdef double[::1] _sine, _cosine, _static, _damper, _nodes, _weights
    cdef int _go(self) noexcept nogil
    cdef void _add(self, double weight) noexcept nogil
