from fcm.motion.flow cimport Flows
from fcm.motion.segments cimport Segments

cdef class Derivative:
    cdef readonly Flows flows
    cdef readonly Py_ssize_t unknowns, at
    cdef readonly double position
    cdef readonly double[:, ::1] columns
    cdef readonly double[::1] rate
    cdef double[:, ::1] _terms, _grades, _rates
    cdef double[:, ::1] _room, _matrix
    cdef void _stand(self, Segments segments) noexcept nogil
    cdef Py_ssize_t _go(self, Segments segments, Py_ssize_t last, double position) noexcept nogil
    cdef void _follow(self, Py_ssize_t slot, double position) noexcept nogil
    cdef void _whole(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void _times(self, double[:, ::1] matrix) noexcept nogil
    cdef void _fraction(self, Py_ssize_t slot, double x, Py_ssize_t orders) noexcept nogil
    cdef void _part(self, Py_ssize_t slot, double x) noexcept nogil
    cdef void _across(self, Segments segments, Py_ssize_t i, Py_ssize_t old, Py_ssize_t new) noexcept nogil
    cdef void _put_friction(self, double[:, ::1] z, Py_ssize_t k, Segments segments, Py_ssize_t i, bint every) noexcept nogil
