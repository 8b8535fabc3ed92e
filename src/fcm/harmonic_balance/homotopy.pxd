from fcm.continuation.problem cimport Problem
from fcm.harmonic_balance.residual cimport Balance

cdef class Level(Problem):
    cdef public Balance balance
    cdef public double omega
    cdef bint many
    cdef double[::1] z
    cdef void place(self, double[::1] z) noexcept

cdef class Homotopy(Problem):
    cdef public Problem inner
    cdef public double taken
    cdef public double[::1] removed
