from fcm.contact.closed_form cimport ClosedForm, CoefficientLaw

cdef class AtlasPoint:
    # of the table
    cdef double span_1, span_2, span_x, span_z
    cdef int first_slip
    cdef double near
    # of the point
    cdef double sin_half, cos_half, sin_phi, cos_phi
    cdef double ell_1, ell_2, low, high, width
    cdef double sign, u, x, z, scale, mean, closed
    # the chain rule
    cdef double u_n, u_b, u_phi, x_b, x_phi, z_phi, scale_b, scale_phi, mean_n, mean_b, mean_phi

    cdef void find(self, double n0, double b, double phi, bint gradient) noexcept nogil
    cdef void set_phase(self, double phi) noexcept nogil
    cdef void geometry(self, double b_bar) noexcept nogil
    cdef void _variation(self, double b) noexcept nogil
    cdef void _phase(self, double phi) noexcept nogil
    cdef void _separation(self, double n0, double b, bint gradient) noexcept nogil
    cdef void _slip(self, double b, double excess, bint gradient) noexcept nogil
    cdef void _slip_slopes(self, double b, double t, double by_t) noexcept nogil

cdef class Cubic:
    cdef const float[::1] coefficients
    cdef Py_ssize_t step_u, step_x, last
    cdef void evaluate(
        self, double u, double x, double z, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil

cdef (double, double, double, double) weights(double f) noexcept nogil
cdef (double, double, double, double) slopes(double f) noexcept nogil

cdef class Frame:
    cdef const double[:, ::1] low, high, here
    cdef bint within(self, AtlasPoint place) noexcept nogil

cdef class Tabulated(CoefficientLaw):
    cdef Cubic cubic
    cdef AtlasPoint place
    cdef Frame frame
    cdef ClosedForm exact
    cdef readonly long long outside
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
    cdef void _chain(self, double[::1] out, Py_ssize_t at) noexcept nogil
