from fcm.contact.periodic.motion cimport Motion
from fcm.contact.periodic.cycle cimport Cycle

cdef int STICKS, SIGNED_SLIPS, CONTACT, LONG

cdef class Integrals:
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly int most, highest
    cdef double[:, ::1] cos_sum, sin_sum, power_cos, power_sin
    cdef double[::1] total_re, total_im, stick_re, stick_im, grow_re, grow_im, points, weights, reciprocal
    cdef void integrate(self) noexcept nogil
    cdef void piece(self, int p, int begin, int end, double length) noexcept nogil
    cdef void powers(self, int into, double c_1, double s_1) noexcept nogil
    cdef void short_stick(self, int p, int begin, double length) noexcept nogil
    cdef void grow(self, double re, double im) noexcept nogil
    cdef void product(self, int h, int which, int row) noexcept nogil
