from fcm.time_domain.forcing cimport Forced

cdef class Exits(Forced):
    cdef double[:, ::1] _rotated
    cdef void _angles(self, Py_ssize_t slot) noexcept nogil
    cdef void _of_exit(self, Py_ssize_t slot, Py_ssize_t e, int a) noexcept nogil
    cdef void expand(self, Py_ssize_t slot, Py_ssize_t e) noexcept nogil
    cdef void make_columns(self, Py_ssize_t slot, Py_ssize_t steps) noexcept nogil
    cdef void watch(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, Py_ssize_t steps, double[::1] seen) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, Py_ssize_t e, double[:, ::1] y, Py_ssize_t k, double[:, ::1] powers) noexcept nogil

cdef double value(double[::1] powers, int order, double x) noexcept nogil
cdef double root(double[::1] powers, int order, double low, double high) noexcept nogil
cdef int needed(double x) noexcept nogil
cdef void summed(double[:, ::1] terms, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil

cdef class Flows(Exits):
    cdef int advance(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) except -1 nogil
    cdef int carry(self, Py_ssize_t slot, double position, double[:, ::1] y, Py_ssize_t k) except -1 nogil
    cdef void bound(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] out) noexcept nogil
    cdef void taylor(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] terms) noexcept nogil
    cdef void part(self, Py_ssize_t slot, double x, double[:, ::1] y, Py_ssize_t first, Py_ssize_t last) noexcept nogil
