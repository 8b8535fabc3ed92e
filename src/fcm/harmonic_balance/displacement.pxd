from fcm.harmonic_balance.peak_to_peak cimport Extremes
from fcm.structure.receptance cimport Receptance

cdef class Displacements(Extremes):
    cdef public Receptance seen
    cdef public double[:, ::1] shapes
    cdef public double[:, ::1] static
    cdef public double[:, ::1] attached
    cdef public int[::1] apart
    cdef double[:, ::1] of_modes
    cdef double q_re, q_im, r_re, r_im
    cdef public double[::1] mean
    cdef public double[::1] rest
    cpdef int at(self, double load, double[::1] force, double[::1] d_force, double[::1] z, double[::1] direction) except -1
    cdef int harmonic(self, int j, double load, double[::1] force, double[::1] d_force, double d_omega) except -1
    cdef int sum_modes(self) except -1
    cdef void move(self, Receptance seen, int j, Py_ssize_t i, double f_re, double f_im, double g_re, double g_im, double d_omega) noexcept
    cdef void from_ports(self, Py_ssize_t d, double[::1] z, double[::1] direction) noexcept
