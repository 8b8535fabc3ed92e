from fcm.motion.forced cimport Forced

cdef class Flows(Forced):
    cdef double[::1] _whole
    cdef void advance(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void carry(self, Py_ssize_t slot, double position, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void watch(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, Py_ssize_t steps, double[::1] seen) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, Py_ssize_t e, double[:, ::1] y, Py_ssize_t k, double[:, ::1] powers) noexcept nogil
    cdef void bound(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] out) noexcept nogil
