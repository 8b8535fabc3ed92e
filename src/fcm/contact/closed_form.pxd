cdef int UNKNOWN, STUCK, SLIPPING, OPEN
cdef double PI, NAN

cdef class SlipLimits:
    cdef double n0, b, sin_phi, cos_phi
    cdef double ell_1, ell_2, sin_P, cos_P, sin_N, cos_N, lower_P, upper_N
    cdef int behaviour(self, double n0_bar, double b_bar, double phi) noexcept nogil
    cdef double stuck_force(self) noexcept nogil
    cdef void _limits(self, double phi) noexcept nogil

cdef class HarmonicCycle(SlipLimits):
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

cdef class Sequence(HarmonicCycle):
    cdef int count
    cdef double min_change, last_slip, state, since
    cdef double[:, ::1] regions
    cdef void of(self, double n0_bar, double b_bar, double phi) noexcept nogil
    cdef void take(self) noexcept nogil
    cdef double _seen(self) noexcept nogil
    cdef void _region(self, int letter, double since, double w) noexcept nogil

cdef class CoefficientLaw:
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
    cdef void unknown(self, bint gradient, double[::1] out, Py_ssize_t at) noexcept nogil
    cdef bint _fill(
        self,
        const double[::1] n0_bar,
        const double[::1] b_bar,
        const double[::1] phi,
        bint gradient,
        double[::1] out,
        Py_ssize_t numbers,
    ) noexcept

cdef class CoefficientIntegrals(HarmonicCycle):
    cdef bint light, gradient
    cdef double light_load
    cdef double F_b, F_s, F_c
    cdef double b_n, b_b, b_phi, s_n, s_b, s_phi, c_n, c_b, c_phi
    cdef double kept_n, kept_b, kept_phi, force, span_b, span_s, span_c
    cdef int sum(self, double n0_bar, double b_bar, double phi, bint gradient) noexcept nogil
    cdef void take(self) noexcept nogil
    cdef void _divide(self) noexcept nogil
    cdef void _stuck(self) noexcept nogil
    cdef double _load(self, double sin_theta, double cos_theta) noexcept nogil
    cdef void _keep(self, double pull, double sin_theta, double cos_theta) noexcept nogil
    cdef void _motion(self) noexcept nogil
    cdef void _stick_force(self) noexcept nogil
    cdef void _stick_gradient(self) noexcept nogil
    cdef void _slipped(self) noexcept nogil

cdef class ClosedForm(CoefficientLaw):
    cdef CoefficientIntegrals integrals
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil

cdef class Boundaries(CoefficientLaw):
    cdef SlipLimits limits
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
