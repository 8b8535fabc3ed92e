from fcm.time_domain.event_detection cimport EventDetector
from fcm.time_domain.flow cimport Flows
from fcm.time_domain.segments cimport Segments

cdef class Successor:
    cdef readonly Flows flows
    cdef EventDetector ahead
    cdef double[:, ::1] y
    cdef signed char[:, ::1] states
    cdef Py_ssize_t _passes
    cdef bint _fresh
    cdef double[::1] _noise
    cdef signed char[::1] _failed
    cdef void begins(self) noexcept
    cdef void rounded(self, double[:, ::1] y) noexcept nogil
    cdef int settle(self) except -1 nogil
    cdef bint _fails(self, Py_ssize_t slot) noexcept nogil
    cdef void _switch(self, Py_ssize_t slot) noexcept nogil
    cdef void _descends(self, Py_ssize_t slot, Py_ssize_t e) noexcept nogil

cdef class March:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t limit
    cdef readonly double time, duration
    cdef readonly double[:, ::1] y
    cdef readonly signed char[:, ::1] states
    cdef EventDetector _ahead
    cdef Successor _next
    cdef bint _settled
    cdef void _enter(self, Py_ssize_t j)
    cdef int _go(self) except -1 nogil
    cdef void _open_segment(self) noexcept nogil
    cdef void _close_segment(self) noexcept nogil
