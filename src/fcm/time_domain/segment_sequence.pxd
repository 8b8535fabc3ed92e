from fcm.time_domain.segments cimport Segments
from fcm.stability.state_sequence cimport StateSequence

cdef class SegmentSequence(StateSequence):
    cdef int computed
    cdef double[:, ::1] law, tangential, normal
    cpdef int take(self, Segments segments, double duration) except -1
    cdef int _state(self, Segments segments, Py_ssize_t k, int c) noexcept
    cdef void _change(self, Segments segments, Py_ssize_t k, Py_ssize_t before, int c, double angle) noexcept
    cdef double _velocity(self, double[:, ::1] shape, Segments segments, Py_ssize_t k, int c) noexcept
