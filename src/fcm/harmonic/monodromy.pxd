from fcm.harmonic.disturbance cimport Disturbances
from fcm.harmonic.transitions cimport Transitions

cdef class Monodromy(Disturbances):
    cdef readonly Transitions transitions
    cdef double[:, ::1] port
    cpdef int follow(self, double omega) except -1
    cdef int begin(self) except -1
    cdef int happen(self, int e) except -1
