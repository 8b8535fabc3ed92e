cdef class Receptance:
    cdef public int modes
    cdef public int ports
    cdef public int count
    cdef public int stride
    cdef public Py_ssize_t[::1] mean_at
    cdef public Py_ssize_t[::1] wave_at
    cdef public double omega
    cdef public double[::1] harmonics
    cdef public double[::1] natural
    cdef public double[::1] rate
    cdef public double[:, ::1] shapes
    cdef public double[:, ::1] force_re
    cdef public double[:, ::1] force_im
    cdef public double[:, ::1] slope_re
    cdef public double[:, ::1] slope_im
    cdef public double[:, ::1] constant_re
    cdef public double[:, ::1] constant_im
    cdef public double[:, ::1] square_re
    cdef public double[:, ::1] square_im
    cdef public double[:, ::1] static
    cdef public bint large
    cdef public bint summed
    cdef public double[:, ::1] pairs
    cdef public double[:, ::1] total
    cdef public double[:, ::1] weights
    cdef public double[:, ::1] sum
    cdef public double[:, ::1] c_re
    cdef public double[:, ::1] c_im
    cdef public double[:, ::1] s_re
    cdef public double[:, ::1] s_im
    cdef public double[:, :, ::1] G_re
    cdef public double[:, :, ::1] G_im
    cdef public double[:, :, ::1] dG_re
    cdef public double[:, :, ::1] dG_im
    cdef public double[:, ::1] X_re
    cdef public double[:, ::1] X_im
    cdef public double[:, ::1] dX_re
    cdef public double[:, ::1] dX_im
    cdef public int[::1] forced
    cdef public int first
    cpdef int at(self, double omega) except -1
    cdef void forces(self) noexcept
    cdef void compliances(self) noexcept
    cdef void sums(self, int j) noexcept
    cdef void sums_by_pairs(self, int j) noexcept
    cdef int large_sums(self) except -1
    cdef void external(self) noexcept
    cdef void answer(self, int j, int n) noexcept
