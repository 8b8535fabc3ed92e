from fcm.motion.pool cimport Pool

cdef class Equations(Pool):
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] z, Py_ssize_t last, double step, double[:, ::1] y, bint graded) noexcept nogil
