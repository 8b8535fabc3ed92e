from fcm.contact.plane.motion cimport PlaneMotion
from fcm.contact.plane.panel cimport Panel

cdef int STICKS, CONTACT, SLIPS_X, SLIPS_Y

cdef class Sums:
    cdef readonly PlaneMotion motion
    cdef readonly int most, highest
    cdef readonly double[:, ::1] cos_sum, sin_sum, power_cos, power_sin
    cdef readonly double[::1] held_x_re, held_x_im, held_y_re, held_y_im, reciprocal
    cdef readonly double work, path
    cdef double re, im
    cdef void begin(self) noexcept nogil
    cdef void powers(self, int into, double c_1, double s_1) noexcept nogil
    cdef void contact(self, double begin, double end) noexcept nogil
    cdef void stick(self, double begin, double end, double w_x, double w_y) noexcept nogil
    cdef void slip(self, Panel panel) noexcept nogil
    cdef void product(self, int h, int which, int row) noexcept nogil
