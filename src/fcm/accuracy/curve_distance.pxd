from fcm.harmonic_balance.prolongation cimport Prolongation

cdef class PointwiseDisplacement:
    cdef public Prolongation prolongation
    cdef public double missed
    cdef int predict_from_nearest(self, Py_ssize_t i, double[:, ::1] z, double[:, ::1] reference_unknowns, unsigned char[::1] known) except -1
