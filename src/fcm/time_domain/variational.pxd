from fcm.time_domain.flow_derivative cimport Along
from fcm.time_domain.segments cimport Segments

cdef class Derivative(Along):
    cdef readonly Py_ssize_t at
    cdef readonly double position
    cdef readonly double[::1] rate
    cdef double[:, ::1] _rates
    cdef void _stand(self, Segments segments) noexcept nogil
    cdef Py_ssize_t _go(self, Segments segments, Py_ssize_t last, double position) except -2 nogil
    cdef Py_ssize_t _reach(self, Segments segments, Py_ssize_t last, double position) except -2 nogil
    cdef int _arrive(self, Segments segments, Py_ssize_t slot) except -1 nogil
    cdef void _across(self, Segments segments, Py_ssize_t i, Py_ssize_t old, Py_ssize_t new) noexcept nogil
    cdef void _put_friction(self, double[:, ::1] z, Py_ssize_t k, Segments segments, Py_ssize_t i, bint every) noexcept nogil
