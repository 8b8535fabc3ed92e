from fcm.harmonic.sequence cimport Sequence

cdef class Monodromy:
    cdef readonly Sequence sequence
    cdef readonly int modes, contacts, size, memories
    cdef bint soft
    cdef double omega, rate
    cdef double[:, ::1] shapes, contact, S, B, T, K, W, port, X, term, work, image
    cdef double[::1] natural, damping
    cdef object flexibility
    cdef int[::1] state
    cpdef int follow(self, double omega) except -1
    cdef int begin(self) except -1
    cdef int happen(self, int e) except -1
    cdef int assemble(self) except -1
    cdef int soften(self) except -1
    cdef int propagate(self, double length) except -1
    cdef int apply(self, double h) except -1
