cdef int COSTLY_SIZE
cdef int NONE

cdef class Problem:
    cdef public int unknowns
    cdef public int margins
    cdef public int outputs
    cdef public int rank
    cdef public int group
    cdef public bint labelled
    cdef public bint rooted
    cdef public bint costly
    cdef public double unbounded
    cdef public double[::1] residual
    cdef public double[:, ::1] jacobian
    cdef public double[::1] scale
    cdef public double[::1] margin
    cdef public int[::1] kind
    cdef public double[::1] angle
    cdef public double[::1] output
    cdef public double[::1] growth
    cpdef int evaluate(self, double[::1] z) except -1
    cpdef int probe(self, double[::1] z) except -1
    cpdef int measure(self, double[::1] z) except -1
    cpdef int bound(self, double[::1] z) except -1
    cpdef int report(self, double[::1] z, double[::1] direction) except -1
    cpdef double factor(self, double[::1] row, double[::1] scale) except -2.0
    cpdef int solve(self, double[::1] right) except -1
