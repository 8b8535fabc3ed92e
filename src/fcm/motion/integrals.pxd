from fcm.motion.steps cimport Steps

cdef class Integrals:
    cdef readonly Steps steps
    cdef readonly double[::1] mean, sine, cosine
    cdef double[::1] _real, _imag, _even, _weights, _nodes
    cdef double[:, ::1] _sums
    cdef Py_ssize_t _slot
    cdef int _go(self) noexcept nogil
    cdef void _moments(self) noexcept nogil
    cdef void _integrate(self) noexcept nogil
