from fcm.harmonic_balance.displacement cimport Displacements

cdef class TravellingDisplacements(Displacements):
    cdef public list waves
    cdef double[:, :, ::1] wave_re
    cdef double[:, :, ::1] wave_im
    cdef int harmonic(self, int j, double load, double[::1] force, double[::1] d_force, double d_omega) except -1
    cdef void clear(self, int j) noexcept
    cdef int sum_modes(self) except -1
