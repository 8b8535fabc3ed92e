from fcm.stability.disturbance cimport Disturbances
from fcm.stability.state_sequence cimport StateSequence

cdef class Monodromy(Disturbances):
    cdef readonly StateSequence sequence
    cdef double[:, ::1] port
    cpdef int follow(self, double omega) except -1
    cdef int begin(self) except -1
    cdef int apply_event(self, int e) except -1

cdef class RingMonodromy(Monodromy):
    cdef double part, start
    cdef object renumber, source
    cdef int first
    cdef int[::1] memory
    cpdef int follow(self, double omega) except -1
    cdef void widest(self) noexcept
    cdef int begin(self) except -1
