from fcm.motion.series cimport Series

cdef class Flows(Series):
    cdef double[::1] _whole
    cdef double[:, ::1] _terms, _grades
    cdef void advance(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void watch(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] seen) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] powers) noexcept nogil
    cdef void bound(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] out) noexcept nogil
    cdef void refresh(self, Py_ssize_t slot) noexcept nogil
    cdef void _unit(self, Py_ssize_t slot, Py_ssize_t b) noexcept nogil
    cdef void _unit_exits(self, Py_ssize_t slot, Py_ssize_t b) noexcept nogil
    cdef void reach(self, Py_ssize_t slot, Py_ssize_t last) noexcept nogil
    cdef void _double(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void _look(self, Py_ssize_t slot) noexcept nogil
