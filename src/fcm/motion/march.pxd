from fcm.motion.flow cimport Flows
from fcm.motion.lookout cimport Lookout
from fcm.motion.segments cimport Segments

cdef class March:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t limit
    cdef readonly double time, duration
    cdef readonly double[:, ::1] y
    cdef readonly signed char[:, ::1] states
    cdef Lookout _ahead
    cdef Py_ssize_t _passes
    cdef bint _settled, _fresh
    cdef double[::1] _noise
    cdef signed char[::1] _failed
    cdef void _enter(self, Py_ssize_t j)
    cdef int _go(self) noexcept nogil
    cdef int _settle(self) noexcept nogil
    cdef bint _fails(self, Py_ssize_t slot) noexcept nogil
    cdef void _switch(self, Py_ssize_t slot) noexcept nogil
    cdef void _descends(self, Py_ssize_t slot, Py_ssize_t e) noexcept nogil
    cdef void _open_segment(self) noexcept nogil
    cdef void _close_segment(self) noexcept nogil
