from fcm.motion.walk cimport Walk

cdef class Integrals(Walk):
    cdef readonly double[:, ::1] sums
    cdef double[::1] _nodes
    cdef double[:, ::1] _shares, _weights, _part, _near, _far
    cdef void _weigh(self, double angle) noexcept nogil
    cdef void _add(self, double h) noexcept nogil
