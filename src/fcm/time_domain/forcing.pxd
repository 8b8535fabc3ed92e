from fcm.time_domain.taylor_series cimport Series

cdef class Forced(Series):
    cdef double[::1] whole
    cdef int refresh(self, Py_ssize_t slot) except -1 nogil
    cdef int reach(self, Py_ssize_t slot, Py_ssize_t last) except -1 nogil
    cdef void _one_step(self, Py_ssize_t slot) noexcept nogil
    cdef void _sum_terms(self, Py_ssize_t slot, Py_ssize_t h) noexcept nogil
    cdef void _add_term(self, Py_ssize_t slot, Py_ssize_t h, int j, double power, double slope) noexcept nogil
    cdef void _sized(self, Py_ssize_t slot) noexcept nogil
    cdef void _double(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void free(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) noexcept nogil
