from fcm.contact.plane.motion cimport PlaneMotion
from fcm.contact.plane.panel cimport Panel

cdef int STICKS, CONTACT, SLIPS_X, SLIPS_Y

cdef extern from *:
    """
    #if defined(__GNUC__)
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));
    #if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__)
    #define FCM_TURN __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_TURN __attribute__((unused))
    #endif

    /* To sums (4 (highest + 1), 8) of eight nodes: x and y times cosine and sine of 0, 1, 2, ... times an angle,
       with cosine c and sine s. */
    FCM_TURN static int fcm_turn_eight(
        const double *x, const double *y, const double *c, const double *s, double *sums, int highest)
    {
        const fcm_eight X = *(const fcm_eight *)x, Y = *(const fcm_eight *)y;
        const fcm_eight C = *(const fcm_eight *)c, S = *(const fcm_eight *)s;
        fcm_eight a = C - C + 1.0, b = C - C;
        for (int m = 0; m <= highest; m++, sums += 32) {
            *(fcm_eight *)sums += X * a, *(fcm_eight *)(sums + 8) += X * b;
            *(fcm_eight *)(sums + 16) += Y * a, *(fcm_eight *)(sums + 24) += Y * b;
            const fcm_eight turned = a * C - b * S;
            b = b * C + a * S, a = turned;
        }
        return 1;
    }
    #else
    #define fcm_turn_eight(x, y, c, s, sums, highest) 0
    #endif
    """
    bint turn_eight "fcm_turn_eight"(
        const double *, const double *, const double *, const double *, double *, int) noexcept nogil

cdef class Sums:
    cdef readonly PlaneMotion motion
    cdef readonly int most, highest
    cdef readonly double[:, ::1] cos_sum, sin_sum, power_cos, power_sin
    cdef readonly double[::1] held_x_re, held_x_im, held_y_re, held_y_im, reciprocal
    cdef readonly double work, path
    cdef double re, im
    cdef double[:, ::1] lanes
    cdef double x[8]
    cdef double y[8]
    cdef double c[8]
    cdef double s[8]
    cdef void begin(self) noexcept nogil
    cdef void powers(self, int into, double c_1, double s_1) noexcept nogil
    cdef void contact(self, double begin, double end) noexcept nogil
    cdef void stick(self, double begin, double end, double w_x, double w_y) noexcept nogil
    cdef void slip(self, Panel panel) noexcept nogil
    cdef void total(self) noexcept nogil
    cdef void product(self, int h, int which, int row) noexcept nogil
