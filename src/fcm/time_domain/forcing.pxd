from fcm.time_domain.segments cimport Pool

cdef class Series(Pool):
    cdef double[:, ::1] _own
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] z, Py_ssize_t last, double step, double[:, ::1] y, bint graded) noexcept nogil

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
