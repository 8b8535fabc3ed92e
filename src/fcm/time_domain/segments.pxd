from fcm.stability.state_sequence cimport StateSequence
from fcm.time_domain.flow cimport Flows

cdef class Segments:
    cdef public Py_ssize_t count
    cdef double[:, ::1] _numbers
    cdef readonly double[:, :] y, slack
    cdef readonly signed char[:, ::1] states
    cdef readonly double[:] start, length, ended
    cdef void _part(self, Py_ssize_t size)

cdef class Walk:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t at, span
    cdef double[:, ::1] ahead
    cdef int _go(self) except -2 nogil
    cdef int visit(self, Py_ssize_t slot) except -1 nogil

cdef class Steps:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t at, slot
    cdef readonly double left, length, time, h
    cdef readonly double[:, ::1] y, terms
    cdef int next(self) except -2 nogil

cdef class SegmentSequence(StateSequence):
    cdef int computed
    cdef double[:, ::1] law, tangential, normal
    cpdef int take(self, Segments segments, double duration) except -1
    cdef int _state(self, Segments segments, Py_ssize_t k, int c) noexcept
    cdef void _change(self, Segments segments, Py_ssize_t k, Py_ssize_t before, int c, double angle) noexcept
    cdef double _velocity(self, double[:, ::1] shape, Segments segments, Py_ssize_t k, int c) noexcept
