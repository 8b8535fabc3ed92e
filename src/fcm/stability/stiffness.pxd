cdef class Stiffness:
    cdef readonly int modes, contacts
    cdef bint soft
    cdef readonly double omega, rate
    cdef readonly double[:, ::1] shapes, contact, K, image
    cdef double[:, ::1] S, B, seen, W, work
    cdef readonly double[::1] damping
    cdef double[::1] natural, ratio
    cdef object flexibility
    cdef dict known
    cdef int most
    cdef bint made
    cdef int at(self, double omega) except -1
    cdef int assemble(self, int[::1] state, bytes key) except -1
    cdef int make(self) except -1
    cdef void contacts_alone(self, int[::1] state) noexcept
    cdef void condense(self) noexcept
    cdef void modal(self) noexcept
    cdef int displacement(self, Py_ssize_t port, double[:, ::1] X, double[::1] out) except -1
