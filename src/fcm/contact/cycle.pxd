from fcm.contact.slip_limits cimport SlipLimits

cdef double PI

cdef class Cycle(SlipLimits):
    cdef bint opens
    cdef double theta_1, closing_rate, first_sin, first_cos, pull
    # the span that it is at
    cdef int span
    cdef double start_sin, start_cos, end_sin, end_cos, length
    cdef double w_start, w_end, side, slope, curvature
    cdef double slip, begin_sin, begin_cos, sin, versine, deficit
    cdef bint goes_on

    cdef int find(self, double n0_bar, double b_bar, double phi) noexcept nogil
    cdef void take(self) noexcept nogil
    cdef void _pass(self) noexcept nogil
    cdef void _start(self) noexcept nogil
    cdef void _until_P(self, double length) noexcept nogil
    cdef void _until_N(self, double length) noexcept nogil
    cdef void _until_open(self, double length) noexcept nogil
    cdef void _until(self, double lower, double upper, double length) noexcept nogil
    cdef void _slip(self, double slope, double curvature, bint turns) noexcept nogil
    cdef void _end(self) noexcept nogil

cdef double angle_from(double sin_0, double cos_0, double sin_1, double cos_1) noexcept nogil
cdef double beyond_sine(double y, double sine) noexcept nogil
cdef (double, double, double) arc(double y) noexcept nogil
