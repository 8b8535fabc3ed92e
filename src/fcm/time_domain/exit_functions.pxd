from fcm.time_domain.forcing cimport Forced

cdef class Exits(Forced):
    cdef double[:, ::1] _rotated
    cdef void _angles(self, Py_ssize_t slot) noexcept nogil
    cdef void _of_exit(self, Py_ssize_t slot, Py_ssize_t e, int a) noexcept nogil
    cdef void expand(self, Py_ssize_t slot, Py_ssize_t e) noexcept nogil
    cdef void make_columns(self, Py_ssize_t slot, Py_ssize_t steps) noexcept nogil
    cdef void watch(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, Py_ssize_t steps, double[::1] seen) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, Py_ssize_t e, double[:, ::1] y, Py_ssize_t k, double[:, ::1] powers) noexcept nogil
