cdef class ContactParameters:
    cdef public double mu, k_u, k_v, n_0, start_x, start_y
    cdef void take_row(self, double[:, ::1] table, Py_ssize_t i) noexcept nogil
    cdef void take(self, ContactParameters other) noexcept nogil
    cdef bint equals(self, ContactParameters other) noexcept nogil
