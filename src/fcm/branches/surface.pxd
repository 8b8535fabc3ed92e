from fcm.continuation.dense_solver cimport Solver
from fcm.harmonic_balance.residual cimport Balance

cdef class Surface:
    cdef public Balance balance
    cdef public int n
    cdef public double[::1] z
    cdef public double[::1] centre
    cdef public double[::1] scale
    cdef public double[:, ::1] axes
    cdef public double[:, ::1] tangents
    cdef public double value
    cdef public int evaluations
    cdef Solver solver
    cdef int max_iterations
    cdef double level_floor
    cdef double tolerance
    cdef double singular_step
    cdef double diverged_step
    cdef double[::1] balance_point
    cdef double[::1] right
    cdef bint condensed
    cdef double[::1] row
    cdef double[::1] by_level
    cdef double[::1] at_level
    cpdef bint recentre(self, double[::1] along, double[::1] across) except -1
    cpdef int evaluate_scale(self, double[::1] z) except -1
    cdef bint orthonormalise(self) except -1
    cpdef bint find(self, double ahead, double aside) except -1
    cdef bint factor(self) except -1
    cdef int evaluate(self) except -1
    cdef int forces(self, double[::1] out) except -1
    cdef bint factor_dense(self) except -1
    cdef bint factor_condensed(self) except -1
    cdef int solve(self, bint equations) except -1
    cdef double correct(self, double ahead, double aside) except -2
    cdef bint compute_tangents(self) except -1


