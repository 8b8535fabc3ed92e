from fcm.time_domain.exit_functions cimport Exits

cdef class Flows(Exits):
    cdef int advance(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) except -1 nogil
    cdef int carry(self, Py_ssize_t slot, double position, double[:, ::1] y, Py_ssize_t k) except -1 nogil
    cdef void bound(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] out) noexcept nogil
    cdef void taylor(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] terms) noexcept nogil
    cdef void part(self, Py_ssize_t slot, double x, double[:, ::1] y, Py_ssize_t first, Py_ssize_t last) noexcept nogil
