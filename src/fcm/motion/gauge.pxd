from fcm.motion.steps cimport Steps

cdef class Gauge:
    cdef readonly Steps steps
    cdef double[::1] _entry
    cdef Py_ssize_t[::1] _column, _first
    cdef bint _integrals
    cdef readonly double[::1] mean, sine, cosine, greatest, least
    cdef readonly double[:, ::1] place
    cdef double[::1] _powers, _real, _imag, _weights, _nodes
    cdef double[:, ::1] _ends
    cdef Py_ssize_t _slot
    cdef double[:, ::1] _here, _there, _old, _new
    cdef int _go(self) noexcept nogil
    cdef int _scan(self) noexcept nogil
    cdef void _scan_segment(self, Py_ssize_t slot) noexcept nogil
    cdef void _look(self, Py_ssize_t slot, double[:, ::1] out) noexcept nogil
    cdef bint _may_turn(self, Py_ssize_t r) noexcept nogil
    cdef void _moments(self) noexcept nogil
    cdef void _integrate(self) noexcept nogil
    cdef void _extremes(self, Py_ssize_t r) noexcept nogil
    cdef double _dot(self, Py_ssize_t r, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void _turn(self, Py_ssize_t r, double low, double high) noexcept nogil
    cdef void _reach_end(self) noexcept nogil
    cdef void _note(self, Py_ssize_t r, double x, double value) noexcept nogil
    cdef double _root(self, int order, double low, double high) noexcept nogil
    cdef double _value(self, int order, double x) noexcept nogil
