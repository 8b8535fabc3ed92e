cdef int OPEN, CLOSED, MIXED, UNKNOWN, STUCK, UNSOLVED
cdef double SMALLEST, SMALLEST_SHARE

cdef class ContactParameters:
    cdef public double mu, k_u, k_v, n_0, start_x, start_y
    cdef void take_row(self, double[:, ::1] table, Py_ssize_t i) noexcept nogil
    cdef void take(self, ContactParameters other) noexcept nogil
    cdef bint equals(self, ContactParameters other) noexcept nogil

cdef class HarmonicMotion:
    cdef readonly int count, directions, highest, moving
    cdef readonly double scale, load_scale, ratio, preload
    cdef readonly int[::1] number
    cdef readonly double[::1] order, mean
    cdef readonly double[:, ::1] re, im
    cdef bint measure(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil

cdef class FourierIntegrals:
    cdef readonly HarmonicMotion motion
    cdef readonly int most, highest
    cdef readonly double[:, ::1] cos_sum, sin_sum, power_cos, power_sin
    cdef double[::1] reciprocal
    cdef double re, im
    cdef void clear(self) noexcept nogil
    cdef void powers(self, int slot, double c_1, double s_1) noexcept nogil
    cdef void add(self, int which, int begin, int end, double length, double value) noexcept nogil
    cdef void product(self, int h, int which, int row) noexcept nogil

cdef class ForceDerivatives:
    cdef FourierIntegrals integrals
    cdef readonly HarmonicMotion motion
    cdef readonly int outputs, unknowns, equations
    cdef readonly int[::1] output, place
    cdef readonly double[:, ::1] jacobian
    cdef double[::1] of_friction, of_normal
    cdef void fill(self, double value) noexcept nogil
    cdef void stick_waves(self) noexcept nogil
    cdef void add_product(self, int i, int direction, int which, int along) noexcept nogil
    cdef void rescale(self, ContactParameters contact) noexcept nogil

cdef class ContactKernel:
    cdef readonly HarmonicMotion motion
    cdef readonly int kind, behaviour, outputs, unknowns, equations
    cdef readonly int[::1] output, place
    cdef readonly double[::1] forces
    cdef readonly double[:, ::1] jacobian
    cdef int evaluate(self, double[::1] x, Py_ssize_t first, ContactParameters contact, bint gradient) noexcept nogil
    cdef int solve(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef void resist(self, ContactParameters contact, double[:, ::1] resistance) noexcept nogil
    cdef void clear(self, double value) noexcept nogil
    cdef void take_waves(self, int direction, int row) noexcept nogil
    cdef void press(self, int row) noexcept nogil
    cdef void rescale(self) noexcept nogil

cdef class CycleMeasures:
    cdef readonly double greatest_load, greatest_friction, dissipation, slip_path
    cdef readonly int pieces
    cdef readonly int[::1] state
    cdef void bear(self, ContactParameters contact) noexcept nogil
