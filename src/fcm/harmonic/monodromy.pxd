from fcm.harmonic.transitions cimport Transitions
from fcm.harmonic.stiffness cimport Stiffness

cdef class Monodromy:
    cdef readonly Transitions transitions
    cdef readonly Stiffness stiffness
    cdef readonly int modes, contacts, size, memories
    cdef double[:, ::1] port, X, term, work, A, E, F
    cdef int[::1] state
    cdef readonly object propagator
    cpdef int follow(self, double omega) except -1
    cdef int begin(self) except -1
    cdef int happen(self, int e) except -1
    cdef int propagate(self, double length) except -1
    cdef int jump(self, double length) noexcept
    cdef void product(self, double[:, ::1] left, double[:, ::1] right, double factor) noexcept
    cdef int apply(self, double h) except -1
