cdef class ForcedModes:
    cdef double[:, ::1] ports
    cdef double[:, ::1] dofs
    cdef double[::1] natural
    cdef double[::1] rate
    cdef double[::1] q_re
    cdef double[::1] q_im
    cpdef int shares(
        self, Py_ssize_t[::1] harmonics, double omega, double[:, :, ::1] force, double[::1] size, double[::1] out
    ) except -1
    cdef void move(self, double w, double[:, ::1] force) noexcept
    cdef double greatest(self, double[::1] size) noexcept
