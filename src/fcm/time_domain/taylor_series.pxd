from fcm.time_domain.flow_cache cimport Pool

cdef class Series(Pool):
    cdef double[:, ::1] _own
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] z, Py_ssize_t last, double step, double[:, ::1] y, bint graded) noexcept nogil
