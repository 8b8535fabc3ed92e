from fcm.stability.disturbance cimport Disturbances
from fcm.stability.state_sequence cimport StateSequence

cdef class Monodromy(Disturbances):
    cdef readonly StateSequence sequence
    cdef double[:, ::1] port
    cpdef int follow(self, double omega) except -1
    cdef int begin(self) except -1
    cdef int happen(self, int e) except -1
