from fcm.continuation.bordered_system cimport BorderedSystem
from fcm.continuation.options cimport NewtonOptions

cdef class Newton(BorderedSystem):
    cdef public NewtonOptions options
    cdef public double close
    cdef public double unsure
    cpdef bint correct(self, double reach, double most=*) except -1
    cdef bint chords(self, double before) except -1
    cpdef bint once(self) except -1
    cpdef bint halve(self, double reach) except -1
    cdef bint converges(self, double reach, double most) except -1
    cpdef bint take_tangent(self) except -1
    cdef bint settled(self, double step, double ratio, int count) except -1
    cdef bint too_far(self, double step, double before, double most, int count) except -1
    cdef bint noise(self, double step, int count) except -1
