from fcm.harmonic_balance.normal_plane_prolongation cimport Lifted

cdef class Displacement:
    cdef public Lifted lifted
    cdef public double missed
    cdef int led(self, Py_ssize_t i, double[:, ::1] z, double[:, ::1] theirs, unsigned char[::1] known) except -1
