from fcm.motion.series cimport Series

cdef class Forced(Series):
    cdef double[::1] _turned
    cdef void refresh(self, Py_ssize_t slot) noexcept nogil
    cdef void reach(self, Py_ssize_t slot, Py_ssize_t last) noexcept nogil
    cdef void _one_step(self, Py_ssize_t slot) noexcept nogil
    cdef void _sized(self, Py_ssize_t slot) noexcept nogil
    cdef void _angles(self, Py_ssize_t slot) noexcept nogil
    cdef void _of_exit(self, Py_ssize_t slot, Py_ssize_t e, int a) noexcept nogil
    cdef void expand(self, Py_ssize_t slot, Py_ssize_t e) noexcept nogil
    cdef void _double(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void look(self, Py_ssize_t slot, Py_ssize_t steps) noexcept nogil
