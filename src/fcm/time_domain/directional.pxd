from fcm.time_domain.variational cimport Derivative
from fcm.time_domain.segments cimport Segments

cdef class Directional(Derivative):
    cdef readonly double pace
    cdef readonly Py_ssize_t done
    cdef double[:, ::1] _series, _angle
    cdef Py_ssize_t _at_places(self, Segments segments, double[:, ::1] places, double[:, ::1] out) except -2 nogil
    cdef void _expand(self, Py_ssize_t slot) noexcept nogil
    cdef void _sum(self, double x, double[:, ::1] out) noexcept nogil
