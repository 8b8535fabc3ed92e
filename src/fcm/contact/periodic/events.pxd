from fcm.contact.periodic.motion cimport Motion

cdef int CLOSES, OPENS, TOP, BOTTOM, MEETS

cdef class Crossings:
    cdef readonly Motion motion
    cdef readonly int count, capacity
    cdef readonly double[::1] angle
    cdef readonly int[::1] kind
    cdef int[::1] open
    cdef double[:, ::1] stack
    cdef readonly int sign
    cdef int row, rising, falling
    cdef public double curvature
    cdef readonly double noise
    cdef double fourth, last, last_value, last_slope
    cdef void begin(self) noexcept nogil
    cdef void search(self, int row, int rising, int falling) noexcept nogil
    cdef void bounds(self) noexcept nogil
    cdef int definite_node(self) noexcept nogil
    cdef void interval(self, int j) noexcept nogil
    cdef bint proved(self, double length, double g_0, double d_0, double g_1, double d_1) noexcept nogil
    cdef void note(self, double theta, double value, double slope) noexcept nogil
    cdef double root(self, int row, double level, double low, double g_low, double d_low, double high, double g_high, double d_high) noexcept nogil

cdef double _cubic(double g_0, double d_0, double g_1, double d_1) noexcept nogil
cdef double _last_root(double c_0, double c_1, double c_2) noexcept nogil

cdef class Events:
    cdef readonly Motion motion
    cdef readonly int events
    cdef readonly int[::1] event_kind
    cdef readonly double[::1] event_cos, event_sin, event_angle, lower, upper, moved
    cdef readonly double[::1] lower_rate, upper_rate, load_rate, motion_rate, margin
    cdef int place(self, double theta, int kind) noexcept nogil
