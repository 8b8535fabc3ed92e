from fcm.stability.stiffness cimport Stiffness

cdef class Disturbances:
    cdef readonly Stiffness stiffness
    cdef readonly int modes, contacts, size, memories
    cdef double[:, ::1] X, term, work, A, E, F
    cdef int[::1] state
    cdef readonly object propagator
    cdef object states, rows, key
    cdef int assemble(self) except -1
    cdef int propagate(self, double length) except -1
    cdef int jump(self, double length) except -1
    cdef void fill(self, double length) noexcept
    cdef int carry(self) except -1
    cdef int product(self, double[:, ::1] left, double[:, ::1] right, double factor) except -1
    cdef int apply(self, double h) except -1
    cdef int resist(self, Py_ssize_t columns) except -1
    cdef void drag(self, Py_ssize_t columns) noexcept
