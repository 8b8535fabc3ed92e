from fcm.continuation.dense_solver cimport Solver
from fcm.continuation.options cimport NewtonOptions
from fcm.continuation.problem cimport Problem

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
    cdef bint factor(self) except -1
    cdef int solve(self) except -1
    cdef double step(self) except -1
    cdef bint compute_tangent(self) except -1
    cdef bint is_solved(self, double errors) except -1

cdef class Newton(BorderedSystem):
    cdef public NewtonOptions options
    cdef public double tolerance
    cdef public double rounding_step
    cpdef bint correct(self, double reach, double most=*) except -1
    cdef bint chord_steps(self, double before) except -1
    cpdef bint single_step(self) except -1
    cpdef bint correct_by_half_steps(self, double reach) except -1
    cdef bint converges(self, double reach, double most) except -1
    cpdef bint take_tangent(self) except -1
    cdef bint at_rounding(self, double step, double ratio, int count) except -1
    cdef bint too_far(self, double step, double before, double most, int count) except -1
    cdef bint is_rounding(self, double step, int count) except -1
