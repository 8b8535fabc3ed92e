cdef class Rows:
    cdef readonly Py_ssize_t count
    cdef double[::1] entry
    cdef double[:, ::1] dense
    cdef Py_ssize_t[::1] column, first
    cdef double dot(self, Py_ssize_t r, double[:, ::1] y, Py_ssize_t k) noexcept nogil
