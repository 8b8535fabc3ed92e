cdef class Solver:
    cdef public int size
    cdef public double[:, ::1] matrix
    cdef public double[::1] right
    cdef int[::1] swapped
    cdef public double orientation
    cdef object factors
    cpdef bint factor(self) except -1
    cpdef int solve(self) except -1
