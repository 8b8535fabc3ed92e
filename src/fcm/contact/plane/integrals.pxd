from fcm.contact.plane.panel cimport Panel, PlaneMotion

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

cdef extern from *:
    """
    #include <stddef.h>
    #if defined(__GNUC__)
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));
    #if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__)
    #define FCM_COLUMNS __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_COLUMNS __attribute__((unused))
    #endif

    /* Eight columns of the block (8, width) at a time are solved by the factors of a panel, and added to the
       sums (rows, width) with the weights (rows, 8). Nothing is contracted: all processors round alike. */
    FCM_COLUMNS static int fcm_carry_eight(
        const double *matrix, double *block, ptrdiff_t width, ptrdiff_t columns, const double *weight,
        double *sums, ptrdiff_t rows)
    {
        for (ptrdiff_t j = 0; j < columns; j += 8) {
            fcm_eight x[8];
    #pragma GCC unroll 8
            for (int i = 0; i < 8; i++)
                x[i] = *(const fcm_eight *)(block + i * width + j);
    #pragma GCC unroll 8
            for (int i = 1; i < 8; i++)
    #pragma GCC unroll 8
                for (int p = 0; p < i; p++)
                    x[i] -= matrix[8 * i + p] * x[p];
    #pragma GCC unroll 8
            for (int i = 7; i >= 0; i--) {
    #pragma GCC unroll 8
                for (int p = i + 1; p < 8; p++)
                    x[i] -= matrix[8 * i + p] * x[p];
                x[i] *= matrix[9 * i];
            }
    #pragma GCC unroll 8
            for (int i = 0; i < 8; i++)
                *(fcm_eight *)(block + i * width + j) = x[i];
            for (ptrdiff_t r = 0; r < rows; r++) {
                const double *w = weight + 8 * r;
                fcm_eight *sum = (fcm_eight *)(sums + r * width + j);
                *sum += ((w[0] * x[0] + w[1] * x[1]) + (w[2] * x[2] + w[3] * x[3]))
                    + ((w[4] * x[4] + w[5] * x[5]) + (w[6] * x[6] + w[7] * x[7]));
            }
        }
        return 1;
    }
    #else
    #define fcm_carry_eight(matrix, block, width, columns, weight, sums, rows) 0
    #endif
    """
    bint carry_eight "fcm_carry_eight"(
        const double *, double *, Py_ssize_t, Py_ssize_t, const double *, double *, Py_ssize_t) noexcept nogil

cdef class Derivatives:
    cdef readonly PlaneMotion motion
    cdef readonly Panel panel
    cdef readonly Sums sums
    cdef readonly int outputs, unknowns, rows, width
    cdef int low, high
    cdef int[::1] place
    cdef bint known
    cdef readonly int[::1] output
    cdef readonly double[:, ::1] jacobian
    cdef readonly double[::1] turn, w_x, w_y
    cdef double[::1] u_x, u_y, r
    cdef double[:, ::1] block, gathered, weight
    cdef void fill(self, double value) noexcept nogil
    cdef void take(self, int low, int high) noexcept nogil
    cdef void moved(self) noexcept nogil
    cdef void start(self) noexcept nogil
    cdef void slide(self, double e_x, double e_y) noexcept nogil
    cdef void rest(self, double e_x, double e_y) noexcept nogil
    cdef void close(self) noexcept nogil
    cdef void close_sliding(self, double e_x, double e_y, double rate) noexcept nogil
    cdef double greatest(self) noexcept nogil
    cdef void carry(self, bint gather) noexcept nogil
    cdef void solve(self, bint gather) noexcept nogil
    cdef void weigh(self) noexcept nogil
    cdef void stick(self, double begin, double end) noexcept nogil
    cdef void direct(self) noexcept nogil
    cdef void row(self, Py_ssize_t row, int rows, int h, int which, int part, double factor) noexcept nogil
    cdef void settle(self, bint kept) noexcept nogil
    cdef void rescale(self, double by_motion, double by_load, double load_by_load) noexcept nogil
