from fcm.time_domain.segments cimport Walk

cdef class Powers(Walk):
    cdef readonly double work, slip, damping, turnover
    cdef readonly double[::1] slips, paths
    cdef bint _everywhere
    cdef double[:, ::1] _y, _terms, _wave
    cdef double[::1] _static, _damper, _nodes, _weights
    cdef void _add(self, double weight) noexcept nogil

cdef class MotionIntegrals(Walk):
    cdef readonly double[:, ::1] sums
    cdef double _length
    cdef double[::1] _nodes
    cdef double[:, ::1] _shares, _weights, _terms, _there, _sums
    cdef int _steps(self, Py_ssize_t slot, long long whole) except -1 nogil
    cdef void _gather(self, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void _weigh(self, double length) noexcept nogil
    cdef void _take(self, Py_ssize_t slot, double[::1] y, int end, double one, double sine, double cosine) noexcept nogil

cdef class SparseRows:
    cdef readonly Py_ssize_t count
    cdef double[::1] entry
    cdef double[:, ::1] dense
    cdef Py_ssize_t[::1] column, first, used
    cdef double dot(self, Py_ssize_t r, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void all(self, double[:, ::1] y, Py_ssize_t k, double[:, ::1] out, Py_ssize_t b) noexcept nogil

cdef class Scan(Walk):
    cdef readonly double[::1] greatest, least
    cdef readonly double[:, ::1] place
    cdef SparseRows _rows
    cdef double[::1] _powers
    cdef double[:, ::1] _there, _terms, _path
    cdef double[:, :, ::1] _values
    cdef double _first, _length
    cdef Py_ssize_t _steps(self, Py_ssize_t slot, double left) except -1 nogil
    cdef void _rows_at(self, Py_ssize_t slot, Py_ssize_t k) noexcept nogil
    cdef void _note_ends(self, Py_ssize_t count, double last) noexcept nogil
    cdef void _step(self, Py_ssize_t slot, Py_ssize_t k) noexcept nogil
    cdef void _spread(self, Py_ssize_t slot, Py_ssize_t k, Py_ssize_t last) noexcept nogil
    cdef bint _may_exceed(self, Py_ssize_t r, Py_ssize_t k) noexcept nogil
    cdef bint _has_extreme(self, Py_ssize_t slot, Py_ssize_t r, Py_ssize_t k) noexcept nogil
    cdef void _extremes(self, Py_ssize_t r, Py_ssize_t k) noexcept nogil
    cdef void _extreme_between(self, Py_ssize_t r, Py_ssize_t k, double low, double high) noexcept nogil
    cdef void _note(self, Py_ssize_t r, double x, double here) noexcept nogil
    cdef void _put(self, Py_ssize_t k, double x) noexcept nogil
