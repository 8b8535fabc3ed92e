from fcm.motion.rows cimport Rows
from fcm.motion.walk cimport Walk

cdef class Scan(Walk):
    cdef readonly double[::1] greatest, least
    cdef readonly double[:, ::1] place
    cdef Rows _rows
    cdef double[::1] _powers
    cdef double[:, ::1] _there, _terms, _old, _new
    cdef double[:, :, ::1] _values
    cdef double _first, _length
    cdef void _span(self, Py_ssize_t slot) noexcept nogil
    cdef void _step(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void _look(self, Py_ssize_t slot, double[:, ::1] out) noexcept nogil
    cdef bint _may_turn(self, Py_ssize_t r) noexcept nogil
    cdef void _extremes(self, Py_ssize_t r) noexcept nogil
    cdef void _turn(self, Py_ssize_t r, double low, double high) noexcept nogil
    cdef void _note(self, Py_ssize_t r, double x, double here) noexcept nogil
