from fcm.continuation.dense_solver cimport Solver
from fcm.continuation.options cimport NewtonOptions
from fcm.continuation.problem cimport Problem

cdef double DIVERGED

cdef class BorderedSystem:
    cdef public Problem problem
    cdef public Solver solver
    cdef public double[::1] z
    cdef public double[::1] scale
    cdef public double[::1] row
    cdef public double[::1] tangent
    cdef public double orientation
    cdef double sign
    cdef public double moved
    cdef public int evaluations
    cdef public object poll
    cdef double[::1] guess
    cdef double[::1] delta
    cdef double[::1] weights
    cdef bint factor(self) except -1
    cdef int solve(self) except -1
    cdef double step(self) except -1
    cdef bint compute_tangent(self) except -1
    cdef double rounding(self, NewtonOptions options) except -1
