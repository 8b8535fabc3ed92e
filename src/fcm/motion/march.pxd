from fcm.motion.flow cimport Flows
from fcm.motion.segments cimport Segments

cdef class March:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t limit
    cdef readonly double time, duration
    cdef readonly double[:, ::1] y
    cdef readonly signed char[:, ::1] states
    cdef Py_ssize_t _slot, _exit, _passes
    cdef bint _settled, _fresh
    cdef double _base, _left
    cdef double[:, ::1] _here, _there, _terms, _powers, _work
    cdef double[::1] _noise, _floors, _seen
    cdef signed char[::1] _failed
    cdef int _go(self) noexcept nogil
    cdef int _settle(self) noexcept nogil
    cdef bint _fails(self) noexcept nogil
    cdef void _switch(self) noexcept nogil
    cdef void _open_segment(self) noexcept nogil
    cdef bint _block(self) noexcept nogil
    cdef void _stand(self, int steps) noexcept nogil
    cdef bint _suspect(self, Py_ssize_t k, Py_ssize_t e) noexcept nogil
    cdef bint _passed(self, double before) noexcept nogil
    cdef void _finish(self, double position, double inside) noexcept nogil
