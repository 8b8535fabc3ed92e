cdef (double, double) modal_stiffness(double natural, double rate, double w, double least_loss) noexcept nogil

cdef class Receptance:
    cdef public int modes
    cdef public int ports
    cdef public int count
    cdef public int stride
    cdef readonly object layout
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
    cdef bint many
    cdef double least_loss
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

cdef class TravellingReceptance(Receptance):
    cdef public list waves
    cdef void from_real(self, int j, Receptance wave) noexcept

cdef class ForcedModes:
    cdef double least_loss
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
