from fcm.contact.cycle cimport Cycle, SlipLimits

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

cdef class Integrals(Cycle):
    cdef bint light, gradient
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
    cdef Integrals integrals
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil

cdef class Boundaries(CoefficientLaw):
    cdef SlipLimits limits
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
