from fcm.motion.pool cimport Pool

cdef class Series(Pool):
    cdef double[:, ::1] _own
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] z, Py_ssize_t last, double step, double[:, ::1] y, bint graded) noexcept nogil
    cdef void taylor(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] terms) noexcept nogil
    cdef void part(self, Py_ssize_t slot, double x, double[:, ::1] y, Py_ssize_t first, Py_ssize_t last) noexcept nogil
cdef int needed(double x) noexcept nogil
cdef void summed(double[:, ::1] terms, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil
