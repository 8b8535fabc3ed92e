from fcm.contact.contact_kernel cimport ContactParameters, HarmonicMotion

cdef int LOAD, LOAD_RATE, LOWER, LOWER_RATE, UPPER, UPPER_RATE, FORCE, FORCE_RATE, REACH
cdef double EPSILON, TWO_PI, FIRST_NODE

cdef class LineMotion(HarmonicMotion):
    cdef readonly int nodes
    cdef readonly bint alone
    cdef readonly double step, first
    cdef readonly double[::1] load_bound, limit_bound
    cdef readonly double[:, ::1] node_cos, node_sin, at
    cdef int few, many, before
    cdef bint fundamental, taken, sampled
    cdef void take_nodes(self, int moving) noexcept nogil
    cdef int load(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef void fill(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef int behaviour(self) noexcept nogil
    cdef void bound(self) noexcept nogil
    cdef void sample(self) noexcept nogil
    cdef (double, double) evaluate(self, int row, double theta) noexcept nogil
    cdef (double, double, double) derivatives(self, int row, int other, double c_1, double s_1) noexcept nogil
    cdef int node_before(self, double theta) noexcept nogil

cdef int CLOSES, OPENS, TOP, BOTTOM, MEETS

cdef class ZeroCrossings:
    cdef readonly LineMotion motion
    cdef readonly int count, capacity
    cdef readonly double[::1] angle
    cdef readonly int[::1] kind, order
    cdef int[::1] open
    cdef double[:, ::1] stack
    cdef readonly int sign
    cdef int row, rising, falling
    cdef public double curvature
    cdef readonly double noise
    cdef double fourth, last, last_value, last_slope, min_interval
    cdef int max_halvings
    cdef void begin(self) noexcept nogil
    cdef void search(self, int row, int rising, int falling) noexcept nogil
    cdef void sort(self) noexcept nogil
    cdef void bounds(self) noexcept nogil
    cdef int definite_node(self) noexcept nogil
    cdef void interval(self, int j) noexcept nogil
    cdef bint proved(self, double length, double g_0, double d_0, double g_1, double d_1) noexcept nogil
    cdef void note(self, double theta, double value, double slope) noexcept nogil
    cdef void begin_at(self, double theta, double value, double slope) noexcept nogil
    cdef double root(self, int row, double level, double high, double g_high, double d_high) noexcept nogil

cdef double _cubic(double g_0, double d_0, double g_1, double d_1) noexcept nogil
cdef double _last_root(double c_0, double c_1, double c_2) noexcept nogil

cdef class CycleEvents:
    cdef readonly LineMotion motion
    cdef readonly int events
    cdef readonly int[::1] event_kind
    cdef readonly double[::1] event_cos, event_sin, event_angle, lower, upper, moved
    cdef readonly double[::1] lower_rate, upper_rate, load_rate, motion_rate, margin
    cdef int place(self, double theta, int kind) noexcept nogil
