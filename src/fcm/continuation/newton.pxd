from fcm.continuation.dense cimport Solver
from fcm.continuation.problem cimport Problem

cdef class Newton:
    cdef public Problem problem
    cdef public Solver solver
    cdef public double[::1] z
    cdef public double[::1] scale
    cdef public double[::1] row
    cdef public double[::1] tangent
    cdef public double orientation
    cdef public double moved
    cdef public double unsure
    cdef public int evaluations
    cdef double[::1] guess
    cdef double[::1] delta
    cdef double[::1] closing
    cpdef bint correct(self, double reach, double most=*) except -1
    cdef bint chords(self, double before) except -1
    cpdef bint look(self) except -1
    cdef bint settled(self, double step, double ratio, int count) except -1
    cdef bint factor(self) except -1
    cdef bint noise(self, double step, int count) except -1
    cdef int solve(self) except -1
    cdef double step(self) except -1
    cdef bint direct(self) except -1
    cdef double rounding(self) except -1
