from fcm.time_domain.flow cimport Flows
from fcm.time_domain.segments cimport Segments

cdef double first_descent(double[:, ::1] powers, Py_ssize_t k, double floor, double negligible, double[:, ::1] work) noexcept nogil

cdef class EventDetector:
    cdef readonly Flows flows
    cdef Py_ssize_t slot, exit
    cdef double base, left, inside
    cdef double[:, ::1] there, powers
    cdef double[::1] slack
    cdef signed char[::1] touched
    cdef int _doubled
    cdef double[:, ::1] _here, _begun, _work
    cdef double[::1] _floors, _largest, _seen
    cdef signed char[::1] _marked
    cdef void begin(self, double[:, ::1] y, double left) noexcept nogil
    cdef bint block(self) except -1 nogil
    cdef bint _suspect(self, Py_ssize_t k, Py_ssize_t e) noexcept nogil
    cdef double _floor(self, Py_ssize_t e) noexcept nogil
    cdef int _stand(self, int steps) except -1 nogil
    cdef bint _passed(self, double before) noexcept nogil

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
