from fcm.continuation.problem cimport Problem
from fcm.harmonic_balance.residual cimport Balance

cdef class ForceLevelProblem(Problem):
    cdef public Balance balance
    cdef public double omega
    cdef bint many
    cdef double[::1] z
    cdef void place(self, double[::1] z) noexcept

cdef class Homotopy(Problem):
    cdef public Problem inner
    cdef public double subtracted_part
    cdef public double[::1] initial_residual
