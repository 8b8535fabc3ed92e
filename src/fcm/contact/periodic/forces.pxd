from fcm.contact.contact_kernel cimport ContactParameters
from fcm.contact.periodic.cycle cimport LineCycle
from fcm.contact.periodic.motion cimport LineMotion

cdef int STICKS, SIGNED_SLIPS, CONTACT, LONG

cdef class Integrals:
    cdef readonly LineMotion motion
    cdef readonly LineCycle cycle
    cdef readonly int most, highest
    cdef double[:, ::1] cos_sum, sin_sum, power_cos, power_sin
    cdef double[::1] total_re, total_im, stick_re, stick_im, grow_re, grow_im, points, weights, reciprocal
    cdef void integrate(self) noexcept nogil
    cdef void piece(self, int p, int begin, int end, double length) noexcept nogil
    cdef void powers(self, int into, double c_1, double s_1) noexcept nogil
    cdef void short_stick(self, int p, int begin, double length) noexcept nogil
    cdef void grow(self, double re, double im) noexcept nogil
    cdef void product(self, int h, int which, int row) noexcept nogil

cdef class Derivatives:
    cdef readonly LineMotion motion
    cdef readonly LineCycle cycle
    cdef readonly Integrals integrals
    cdef readonly int outputs, unknowns
    cdef readonly int[::1] output
    cdef readonly double[:, ::1] jacobian
    cdef double[::1] memory

    cdef void fill(self, double value) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void block(
        self, Py_ssize_t row, int of_load, int rows, int h, int which, double factor
    ) noexcept nogil
    cdef void gradient(self, int p) noexcept nogil
    cdef void remember_all(self) noexcept nogil
    cdef void remember(self, int p) noexcept nogil
    cdef void rescale(self, int row, double by_motion, double by_load) noexcept nogil

cdef class PeriodicContact:
    cdef readonly LineMotion motion
    cdef readonly LineCycle cycle
    cdef readonly Integrals integrals
    cdef readonly Derivatives derivatives
    cdef readonly int kind, outputs, unknowns, equations
    cdef readonly int[::1] output
    cdef readonly double[::1] forces
    cdef readonly double[:, ::1] jacobian

    cdef int evaluate(self, double[::1] x, Py_ssize_t first, ContactParameters contact, bint gradient) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void press(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void rescale(self, ContactParameters contact, bint gradient) noexcept nogil
