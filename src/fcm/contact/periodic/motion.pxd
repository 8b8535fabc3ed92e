cdef int LOAD, LOAD_RATE, LOWER, LOWER_RATE, UPPER, UPPER_RATE, FORCE, FORCE_RATE, REACH, OPEN, CLOSED, MIXED, UNKNOWN
cdef double EPSILON

cdef class Nodes:
    cdef readonly int highest, nodes
    cdef readonly bint alone
    cdef readonly double step, first
    cdef readonly double[:, ::1] node_cos, node_sin
    cdef int few, many, before
    cdef bint fundamental
    cdef void take_nodes(self, int moving) noexcept nogil

cdef class Motion(Nodes):
    cdef readonly int count, moving
    cdef readonly double scale, load_scale, ratio, preload
    cdef readonly int[::1] number
    cdef readonly double[::1] order, mean, load_bound, limit_bound
    cdef readonly double[:, ::1] re, im, at
    cdef bint taken, sampled
    cdef int load(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0) noexcept nogil
    cdef void fill(self, double[::1] x, Py_ssize_t first, double k_u, double k_v) noexcept nogil
    cdef int behaviour(self) noexcept nogil
    cdef void bound(self) noexcept nogil
    cdef void sample(self) noexcept nogil
    cdef (double, double) evaluate(self, int row, double theta) noexcept nogil
    cdef (double, double) rate_and_value(self, int row, int other, double c_1, double s_1) noexcept nogil
    cdef int node_before(self, double theta) noexcept nogil
    cdef double bend(self, int row, double c_1, double s_1) noexcept nogil
