cdef class Rows:
    cdef readonly Py_ssize_t count
    cdef double[::1] entry
    cdef double[:, ::1] dense
    cdef Py_ssize_t[::1] column, first, used
    cdef double dot(self, Py_ssize_t r, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void all(self, double[:, ::1] y, Py_ssize_t k, double[:, ::1] out, Py_ssize_t b) noexcept nogil
