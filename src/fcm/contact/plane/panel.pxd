from fcm.contact.contact_kernel cimport ContactParameters, HarmonicMotion
from fcm.contact.periodic.motion cimport LineMotion

cdef extern from *:
    """
    #include <stddef.h>
    #include <string.h>
    #if defined(__GNUC__)
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));
    typedef long long fcm_eight_whole __attribute__((vector_size(64), aligned(8)));
    #if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__)
    #define FCM_PLACE __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_PLACE __attribute__((unused))
    #endif

    /* Of eight angles, not beyond a million: cosine and sine to a rounding, by the polynomials of fdlibm within
       pi / 4 of a multiple of pi / 2, that in three parts. Then rows of eight: U_x, U_y, R, their derivatives,
       cosine and sine; and those of the harmonics. Amplitudes are rows of re, im (3.., stride). Nothing is
       contracted, so that all processors round alike. */
    FCM_PLACE static int fcm_place_eight(
        const double *angle, const double *re, const double *im, const int *number, int moving, ptrdiff_t stride,
        double mean, double *rows, double *cosines, double *sines)
    {
        const fcm_eight x = *(const fcm_eight *)angle, zero = x - x, one = zero + 1.0;
        const fcm_eight shifted = x * 0.63661977236758134 + 6755399441055744.0;
        const fcm_eight turns = shifted - 6755399441055744.0;
        fcm_eight_whole quarter;
        memcpy(&quarter, &shifted, sizeof quarter);
        const fcm_eight y = ((x - turns * 1.57079632673412561417e+00) - turns * 6.07710050630396597660e-11)
            - turns * 2.02226624879595063154e-21;
        const fcm_eight z = y * y;
        const fcm_eight s = y + y * z * (-1.66666666666666324348e-01 + z * (8.33333333332248946124e-03
            + z * (-1.98412698298579493134e-04 + z * (2.75573137070700676789e-06
            + z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
        const fcm_eight c = one - (0.5 * z - z * z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03
            + z * (2.48015872894767294178e-05 + z * (-2.75573143513906633035e-07
            + z * (2.08757232129817482790e-09 - z * 1.13596475577881948265e-11))))));
        const fcm_eight_whole odd = -(quarter & 1), first = (quarter + 1) << 62, second = quarter << 62;
        fcm_eight_whole s_bits, c_bits;
        memcpy(&s_bits, &s, sizeof s_bits), memcpy(&c_bits, &c, sizeof c_bits);
        const fcm_eight_whole signs = first - first + (long long)(1ULL << 63);
        const fcm_eight_whole to_c = ((odd & s_bits) | (~odd & c_bits)) ^ (first & signs);
        const fcm_eight_whole to_s = ((odd & c_bits) | (~odd & s_bits)) ^ (second & signs);
        fcm_eight c_1, s_1;
        memcpy(&c_1, &to_c, sizeof c_1), memcpy(&s_1, &to_s, sizeof s_1);
        fcm_eight a = c_1, b = s_1, sums[6] = {zero, zero, zero + mean, zero, zero, zero};
        int h = 1;
        for (int k = 0; k < moving; k++) {
            for (; h < number[k]; h++) {
                const fcm_eight turned = a * c_1 - b * s_1;
                b = b * c_1 + a * s_1, a = turned;
            }
            *(fcm_eight *)(cosines + 8 * k) = a, *(fcm_eight *)(sines + 8 * k) = b;
            for (int row = 0; row < 3; row++) {
                const double p = re[row * stride + k], q = im[row * stride + k];
                sums[row] += p * a - q * b;
                sums[3 + row] -= (double)h * (p * b + q * a);
            }
        }
        for (int row = 0; row < 6; row++)
            *(fcm_eight *)(rows + 8 * row) = sums[row];
        *(fcm_eight *)(rows + 48) = c_1, *(fcm_eight *)(rows + 56) = s_1;
        return 1;
    }
    #else
    #define fcm_place_eight(angle, re, im, number, moving, stride, mean, rows, cosines, sines) 0
    #endif
    """
    bint place_eight "fcm_place_eight"(
        const double *, const double *, const double *, const int *, int, Py_ssize_t, double, double *, double *,
        double *) noexcept nogil

cdef int X, Y, REACH, LOAD, SCAN, ROWS

cdef class PlaneMotion(HarmonicMotion):
    cdef readonly object options
    cdef double smooth
    cdef readonly LineMotion normal
    cdef readonly int stages
    cdef readonly double mean_x, mean_y, size, reach
    cdef readonly double[::1] motion_bound, reach_bound
    cdef readonly double[:, ::1] cos, sin, value, node_cos, node_sin
    cdef double node[64]
    cdef double[::1] line
    cdef int load(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef void bound(self) noexcept nogil
    cdef bint rubs(self) noexcept nogil
    cdef void place(self, int slot, double theta) noexcept nogil
    cdef void place_nodes(self, double *theta) noexcept nogil
    cdef void bend(self, int slot) noexcept nogil

cdef extern from *:
    """
    #include <stddef.h>
    /* Eight nodes are a register of eight numbers, or four, or two: compiled for each where the compiler can
       have the processor choose. Nothing is contracted, so that all processors round alike. */
    #if defined(__GNUC__)
    #define FCM_EIGHT
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));
    typedef long long fcm_eight_whole __attribute__((vector_size(64), aligned(8)));
    #if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__)
    #define FCM_WIDEST __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_WIDEST __attribute__((unused))
    #endif

    /* Of the motion at eight nodes, seen from a direction: a, b and r of the equation. */
    FCM_WIDEST static int fcm_face_eight(
        const double *node, const double *speed, double e_x, double e_y, double *a, double *b, double *r)
    {
        const fcm_eight *row = (const fcm_eight *)node, R = row[2], zero = R - R;
        *(fcm_eight *)a = e_x * row[3] + e_y * row[4];
        *(fcm_eight *)b = e_x * row[4] - e_y * row[3];
        const fcm_eight reach = (fcm_eight)((fcm_eight_whole)R & (R > zero));
        *(fcm_eight *)r = 2.0 * reach / *(const fcm_eight *)speed;
        return 1;
    }

    /* A matrix (8, 8), by columns, times eight numbers. */
    static inline __attribute__((always_inline)) void fcm_times_eight(
        const double *matrix, const double *y, double *x)
    {
        const fcm_eight *column = (const fcm_eight *)matrix;
        *(fcm_eight *)x = ((column[0] * y[0] + column[1] * y[1]) + (column[2] * y[2] + column[3] * y[3]))
            + ((column[4] * y[4] + column[5] * y[5]) + (column[6] * y[6] + column[7] * y[7]));
    }

    FCM_WIDEST static int fcm_apply_eight(const double *inverse, const double *y, double *x)
    {
        fcm_times_eight(inverse, y, x);
        return 1;
    }

    /* The equation r D t = b - 2 a t - b t^2 at eight nodes: x, a step of Newton's method. The columns of the
       inverse of its derivatives by t, at t if they are wanted, else those given. Derivatives D of a polynomial
       are by columns. Without pivots: of a rule's derivatives, and positive numbers along the diagonal, none
       vanishes. */
    FCM_WIDEST static int fcm_newton_eight(
        const double *columns, const double *r, const double *a, const double *b, const double *t,
        double *inverse, double *x, int wanted)
    {
        fcm_eight column[8];
        const fcm_eight R = *(const fcm_eight *)r, A = *(const fcm_eight *)a, B = *(const fcm_eight *)b;
        const fcm_eight T = *(const fcm_eight *)t, across = A + B * T;
        const fcm_eight *D = (const fcm_eight *)columns;
        double y[8], own[8];
        fcm_times_eight(columns, t, y);
        *(fcm_eight *)y = B - T * (A + across) - R * *(fcm_eight *)y;
        if (!wanted) {
            fcm_times_eight(inverse, y, x);
            return 1;
        }
        *(fcm_eight *)own = 2.0 * across;
    #pragma GCC unroll 8
        for (int j = 0; j < 8; j++) {
            column[j] = R * D[j];
            column[j][j] += own[j];
        }
    #pragma GCC unroll 8
        for (int k = 0; k < 8; k++) {
            const double pivot = column[k][k];
            if (!(pivot > 1e-300 || pivot < -1e-300))
                return 0;
            column[k][k] = 1.0;
            column[k] *= 1.0 / pivot;
    #pragma GCC unroll 8
            for (int j = 0; j < 8; j++) {
                if (j == k)
                    continue;
                const double part = column[j][k];
                column[j][k] = 0.0;
                column[j] -= part * column[k];
            }
        }
    #pragma GCC unroll 8
        for (int j = 0; j < 8; j++)
            *(fcm_eight *)(inverse + 8 * j) = column[j];
        fcm_times_eight(inverse, y, x);
        return 1;
    }

    /* Rows of eight: directions, e . U', lambda, and how fast t and alpha turn; 0 where directions part more than
       so often in the panel. */
    FCM_WIDEST static int fcm_turn_of_eight(
        const double *columns, const double *node, const double *r, const double *a, const double *b,
        const double *speed, const double *t, double start_x, double start_y, double most, double *change,
        double *rate, double *e_x, double *e_y, double *along, double *push)
    {
        const fcm_eight T = *(const fcm_eight *)t, part = 1.0 / (1.0 + T * T);
        const fcm_eight c = (1.0 - T * T) * part, d = 2.0 * T * part;
        double slope[8];
        fcm_times_eight(columns, t, slope);
        const fcm_eight turned = *(fcm_eight *)slope / *(const fcm_eight *)speed;
        const fcm_eight onward = *(const fcm_eight *)a * c + *(const fcm_eight *)b * d;
        *(fcm_eight *)change = turned, *(fcm_eight *)rate = 2.0 * turned * part;
        *(fcm_eight *)e_x = start_x * c - start_y * d, *(fcm_eight *)e_y = start_y * c + start_x * d;
        *(fcm_eight *)along = onward, *(fcm_eight *)push = onward - *(const fcm_eight *)(node + 40);
        const fcm_eight_whole parts = -2.0 * onward > most * *(const fcm_eight *)r;
        long long any = 0;
    #pragma GCC unroll 8
        for (int i = 0; i < 8; i++)
            any |= parts[i];
        return any == 0;
    }
    #else
    #define fcm_face_eight(node, speed, e_x, e_y, a, b, r) 0
    #define fcm_apply_eight(inverse, y, x) 0
    #define fcm_newton_eight(columns, r, a, b, t, inverse, x, wanted) (-1)
    #define fcm_turn_of_eight(columns, node, r, a, b, speed, t, x, y, most, change, rate, e_x, e_y, along, push) (-1)
    #endif
    """
    bint face_eight "fcm_face_eight"(
        const double *, const double *, double, double, double *, double *, double *) noexcept nogil
    bint apply_eight "fcm_apply_eight"(const double *, const double *, double *) noexcept nogil
    int newton_eight "fcm_newton_eight"(
        const double *, const double *, const double *, const double *, const double *, double *, double *,
        int) noexcept nogil
    int turn_of_eight "fcm_turn_of_eight"(
        const double *, const double *, const double *, const double *, const double *, const double *,
        const double *, double, double, double, double *, double *, double *, double *, double *, double *,
    ) noexcept nogil

cdef enum:
    STAGES = 8  # as radau.py says in Python

cdef class Panel:
    cdef double converged, settled, frozen, steepest, widest, before, growth
    cdef int most_steps
    cdef readonly PlaneMotion motion
    cdef readonly double theta, length, left, fade, start_x, start_y, noise
    cdef readonly double[::1] node, weight, bary, tangent, change, rate, e_x, e_y, push, along, speed
    cdef readonly double[:, ::1] slopes, tail
    cdef bint exact, driven
    cdef double tail_before[8]
    cdef double tail_last[8]
    cdef double inverse[64]
    cdef double columns[64]
    cdef double at[8]
    cdef double fall[8]
    cdef double right[8]
    cdef double missing[8]
    cdef double a[8]
    cdef double b[8]
    cdef double r[8]
    cdef (double, double) gone(self, double part) noexcept nogil
    cdef double start_rate, start_bend
    cdef void begin(self, double theta, double e_x, double e_y, double rate, double bend) noexcept nogil
    cdef bint solve(self, double length, double left) noexcept nogil
    cdef bint newton(self, double slope, double bend) noexcept nogil
    cdef bint improve(self, bint wanted) noexcept nogil
    cdef void residual(self) noexcept nogil
    cdef void apply(self) noexcept nogil
    cdef bint invert(self) noexcept nogil
    cdef bint finish(self) noexcept nogil
    cdef double rest(self) noexcept nogil
    cdef void tails(self) noexcept nogil
    cdef double end_of_slip(self) noexcept nogil
    cdef (double, double) pushed(self, double x) noexcept nogil
    cdef double root(self, double low, double high) noexcept nogil
    cdef double lowest(self, double low, double high) noexcept nogil
    cdef double slope_at(self, int j) noexcept nogil
