from fcm.continuation.problem cimport Problem

cdef class Homotopy(Problem):
    cdef public Problem inner
    cdef public double taken
    cdef public double[::1] removed
