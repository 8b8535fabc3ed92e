from fcm.time_domain.flow cimport Flows
from fcm.time_domain.event_detection cimport Lookout
from fcm.time_domain.segments cimport Segments
from fcm.time_domain.next_states cimport Successor

cdef class March:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t limit
    cdef readonly double time, duration
    cdef readonly double[:, ::1] y
    cdef readonly signed char[:, ::1] states
    cdef Lookout _ahead
    cdef Successor _next
    cdef bint _settled
    cdef void _enter(self, Py_ssize_t j)
    cdef int _go(self) except -1 nogil
    cdef void _open_segment(self) noexcept nogil
    cdef void _close_segment(self) noexcept nogil
