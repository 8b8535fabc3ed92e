from fcm.structure.receptance cimport Receptance

cdef class Extremes:
    cdef public double[::1] harmonics
    cdef public int count
    cdef public int dofs
    cdef public int samples
    cdef public double[:, ::1] parts
    cdef public double[:, ::1] re
    cdef public double[:, ::1] im
    cdef public double[:, ::1] d_re
    cdef public double[:, ::1] d_im
    cdef public double[::1] amplitude
    cdef public double[::1] growth
    cdef public double[:, ::1] angles
    cdef double[:, ::1] cosine
    cdef double[:, ::1] sine
    cdef object sampling
    cdef double[::1] wave
    cdef double[::1] c
    cdef double[::1] s
    cdef double value
    cdef double rate
    cdef double angle, step_tolerance
    cdef int max_steps, block, many_dofs
    cdef int fill(self) except -1
    cdef int many(self) except -1
    cdef void both(self, Py_ssize_t d) noexcept
    cdef void greatest(self, Py_ssize_t d, int side, double between) noexcept
    cdef void single(self, Py_ssize_t d) noexcept
    cdef void several(self, Py_ssize_t d) noexcept
    cdef void extreme(self, Py_ssize_t d, Py_ssize_t k) noexcept
    cdef void waves_at(self, double theta) noexcept

cdef class Displacements(Extremes):
    cdef public Receptance receptance
    cdef public double[:, ::1] shapes
    cdef public double[:, ::1] static
    cdef public double[:, ::1] attached
    cdef public int[::1] without_modes
    cdef bint by_modes
    cdef double[::1] shares
    cdef int[::1] share_ports
    cdef int[::1] share_end
    cdef double[:, ::1] of_modes
    cdef double f_re, f_im, g_re, g_im, q_re, q_im, r_re, r_im
    cdef public double[::1] mean
    cdef public double[::1] rest
    cpdef int at(self, double load, double[::1] force, double[::1] d_force, double[::1] z, double[::1] direction) except -1
    cdef int harmonic(self, int j, double load, double[::1] force, double[::1] d_force, double d_omega) except -1
    cdef int sum_modes(self) except -1
    cdef void move(self, Receptance receptance, int j, Py_ssize_t i, double d_omega) noexcept
    cdef void from_ports(self, Py_ssize_t d, double[::1] z, double[::1] direction) noexcept

cdef class TravellingDisplacements(Displacements):
    cdef public list waves
    cdef double[:, :, ::1] wave_re
    cdef double[:, :, ::1] wave_im
    cdef int harmonic(self, int j, double load, double[::1] force, double[::1] d_force, double d_omega) except -1
    cdef void clear(self, int j) noexcept
    cdef int sum_modes(self) except -1
