from fcm.motion.series cimport Series

cdef class Forced(Series):
    cdef double[:, ::1] _terms, _grades
    cdef void refresh(self, Py_ssize_t slot) noexcept nogil
    cdef void reach(self, Py_ssize_t slot, Py_ssize_t last) noexcept nogil
    cdef void _unit(self, Py_ssize_t slot, Py_ssize_t b) noexcept nogil
    cdef void _unit_exits(self, Py_ssize_t slot, Py_ssize_t b) noexcept nogil
    cdef void _double(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void look(self, Py_ssize_t slot, Py_ssize_t steps) noexcept nogil
