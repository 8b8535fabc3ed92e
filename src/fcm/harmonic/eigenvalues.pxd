cdef class Eigenvalues:
    cdef double[:, ::1] a
    cdef readonly double[::1] re
    cdef readonly double[::1] im
    cdef double[::1] v
    cdef readonly Py_ssize_t n
    cpdef bint find(self, double[:, ::1] matrix) noexcept
    cdef void balance(self) noexcept
    cdef void reduce(self) noexcept
    cdef bint split(self) noexcept
    cdef Py_ssize_t apart(self, Py_ssize_t end) noexcept
    cdef void pair(self, Py_ssize_t k) noexcept
    cdef void sweep(self, Py_ssize_t first, Py_ssize_t end, bint unusual) noexcept
    cdef void reflect(self, Py_ssize_t at, Py_ssize_t count, Py_ssize_t left, Py_ssize_t top, Py_ssize_t end) noexcept

cdef double even(double row, double column) noexcept
