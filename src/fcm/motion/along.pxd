from fcm.motion.flow cimport Flows

cdef class Along:
    cdef readonly Flows flows
    cdef readonly Py_ssize_t unknowns
    cdef readonly double[:, ::1] columns
    cdef readonly double paced
    cdef double[::1] _flat
    cdef double[:, ::1] _terms, _grades, _room, _matrix
    cdef void follow(self, Py_ssize_t slot, double position) noexcept nogil
    cdef void _whole(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void _rotate(self, double c, double s, double time) noexcept nogil
    cdef void _times(self, double[:, ::1] matrix, Py_ssize_t rows) noexcept nogil
    cdef void _row_times(self, double[:, ::1] matrix, Py_ssize_t k) noexcept nogil
    cdef void _fraction(self, Py_ssize_t slot, double x, Py_ssize_t orders) noexcept nogil
    cdef void _part(self, Py_ssize_t slot, double x) noexcept nogil
