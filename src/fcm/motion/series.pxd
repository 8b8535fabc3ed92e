from fcm.motion.pool cimport Pool

cdef class Series(Pool):
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b, double factor) noexcept nogil
    cdef void steepen(self, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b, double factor) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] terms, int known, int last) noexcept nogil
    cdef void taylor(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] terms) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, double[:, ::1] terms, int first, int last, double[:, ::1] exits) noexcept nogil
cdef void summed(double[:, ::1] terms, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil
