from fcm.harmonic.reflections cimport Reflections

cdef class Eigenvalues(Reflections):
    cdef readonly double[::1] re
    cdef readonly double[::1] im
    cdef readonly Py_ssize_t n
    cpdef bint find(self, double[:, ::1] matrix) except -1
    cdef void balance(self) noexcept
    cdef void reduce(self) noexcept
    cdef bint split(self) noexcept
    cdef Py_ssize_t apart(self, Py_ssize_t end) noexcept
    cdef void pair(self, Py_ssize_t k) noexcept
    cdef void sweep(self, Py_ssize_t first, Py_ssize_t end, bint unusual) noexcept

cdef double even(double row, double column) noexcept
