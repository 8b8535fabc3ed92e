from fcm.contact.contact_kernel cimport ForceDerivatives, FourierIntegrals
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

cdef class PlanarIntegrals(FourierIntegrals):
    cdef readonly double[::1] held_x_re, held_x_im, held_y_re, held_y_im
    cdef readonly double work, path
    cdef double[:, ::1] lanes
    cdef double x[8]
    cdef double y[8]
    cdef double c[8]
    cdef double s[8]
    cdef void begin(self) noexcept nogil
    cdef void contact(self, double begin, double end) noexcept nogil
    cdef void stick(self, double begin, double end, double w_x, double w_y) noexcept nogil
    cdef void slip(self, Panel panel) noexcept nogil
    cdef void total(self) noexcept nogil

cdef extern from *:
    """
    #include <stddef.h>
    #if defined(__GNUC__)
    typedef long long fcm_eight_whole __attribute__((vector_size(64), aligned(8)));
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));
    #if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__)
    #define FCM_COLUMNS __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_COLUMNS __attribute__((unused))
    #endif

    /* The right sides (8, width) of what t at eight nodes has from its start and from the motion; see `carry`. */
    FCM_COLUMNS static int fcm_drive_eight(
        const double *t, const double *r, const double *slope, const double *rate, const double *e_x,
        const double *e_y, const double *cosines, const double *sines, const double *order, int count,
        const double *turn, ptrdiff_t width, int moves, double *block)
    {
        double start[8], mean[8], six[48];
        const fcm_eight T = *(const fcm_eight *)t, part = 1.0 + T * T;
        const fcm_eight of_reach = -part * *(const fcm_eight *)rate;
        const fcm_eight across_x = -part * *(const fcm_eight *)e_y, across_y = part * *(const fcm_eight *)e_x;
        *(fcm_eight *)start = -0.5 * *(const fcm_eight *)r * *(const fcm_eight *)slope;
        *(fcm_eight *)mean = of_reach;
        for (int i = 0; i < 8; i++)
            for (ptrdiff_t j = 0; j < width; j += 8)
                *(fcm_eight *)(block + i * width + j) = start[i] * *(const fcm_eight *)(turn + j);
        if (!moves)
            return 1;
        for (int i = 0; i < 8; i++)
            block[i * width + 2] += mean[i];
        for (int k = 0; k < count; k++) {
            const fcm_eight c = *(const fcm_eight *)(cosines + 8 * k), s = *(const fcm_eight *)(sines + 8 * k);
            const fcm_eight c_1 = order[k] * c, s_1 = order[k] * s;
            fcm_eight *one = (fcm_eight *)six;
            one[0] = -across_x * s_1, one[1] = -across_x * c_1, one[2] = -across_y * s_1;
            one[3] = -across_y * c_1, one[4] = of_reach * c, one[5] = -of_reach * s;
            double *into = block + 3 + 6 * k;
            for (int i = 0; i < 8; i++, into += width)
    #pragma GCC unroll 6
                for (int p = 0; p < 6; p++)
                    into[p] += six[8 * p + i];
        }
        return 1;
    }

    /* Rows of eight: what derivatives of t at the nodes add to the means of the forces and to their harmonics, the
       numbers `place` among those of the motion; see `weigh`. */
    FCM_COLUMNS static int fcm_weigh_eight(
        const double *t, const double *weight, const double *speed, const double *reach, const double *e_x,
        const double *e_y, const double *cosines, const double *sines, const int *place, int count, double by,
        double *into)
    {
        const fcm_eight T = *(const fcm_eight *)t, R = *(const fcm_eight *)reach, zero = R - R;
        const fcm_eight w = *(const fcm_eight *)weight * *(const fcm_eight *)speed * by / (1.0 + T * T)
            * (fcm_eight)((fcm_eight_whole)R & (R > zero));
        const fcm_eight x = -w * *(const fcm_eight *)e_y, y = w * *(const fcm_eight *)e_x;
        fcm_eight *row = (fcm_eight *)into;
        row[0] = 0.5 * x, row[1] = 0.5 * y;
        for (int m = 0; m < count; m++) {
            const fcm_eight c = *(const fcm_eight *)(cosines + 8 * place[m]);
            const fcm_eight s = *(const fcm_eight *)(sines + 8 * place[m]);
            row[4 * m + 2] = x * c, row[4 * m + 3] = -x * s, row[4 * m + 4] = y * c, row[4 * m + 5] = -y * s;
        }
        return 1;
    }

    /* Eight columns of the block (8, width) at a time are multiplied by the inverse of a panel, by columns (8, 8),
       and added to the sums (rows, width) with the weights (rows, 8); the last row times `by` is the turn (width).
       Nothing is contracted: all processors round alike. */
    FCM_COLUMNS static int fcm_carry_eight(
        const double *inverse, const double *block, ptrdiff_t width, ptrdiff_t columns, const double *weight,
        double *sums, ptrdiff_t rows, double by, double *turn)
    {
        for (ptrdiff_t j = 0; j < columns; j += 8) {
            fcm_eight x[8];
            if (!rows) {
                const double *a = inverse + 7;
                const double *b = block + j;
                x[7] = *(const fcm_eight *)b * a[0];
                for (int k = 1; k < 8; k++)
                    x[7] += *(const fcm_eight *)(b + k * width) * a[8 * k];
                *(fcm_eight *)(turn + j) = by * x[7];
                continue;
            }
            const fcm_eight first = *(const fcm_eight *)(block + j);
    #pragma GCC unroll 8
            for (int i = 0; i < 8; i++)
                x[i] = inverse[i] * first;
    #pragma GCC unroll 8
            for (int k = 1; k < 8; k++) {
                const fcm_eight next = *(const fcm_eight *)(block + k * width + j);
    #pragma GCC unroll 8
                for (int i = 0; i < 8; i++)
                    x[i] += inverse[8 * k + i] * next;
            }
            *(fcm_eight *)(turn + j) = by * x[7];
            for (ptrdiff_t r = 0; r < rows; r++) {
                const double *w = weight + 8 * r;
                fcm_eight *sum = (fcm_eight *)(sums + r * width + j);
                *sum += ((w[0] * x[0] + w[1] * x[1]) + (w[2] * x[2] + w[3] * x[3]))
                    + ((w[4] * x[4] + w[5] * x[5]) + (w[6] * x[6] + w[7] * x[7]));
            }
        }
        return 1;
    }

    /* Of eight columns of the block at a time: the greatest coefficient, the last or a part of the one before it,
       by their weights (8,) and those of the turn at the start. */
    FCM_COLUMNS static double fcm_rest_eight(
        const double *before, const double *last, double turn_before, double turn_last, double part,
        const double *turn, const double *block, ptrdiff_t width)
    {
        fcm_eight_whole most = {0};
        for (ptrdiff_t j = 0; j < width; j += 8) {
            const fcm_eight first = *(const fcm_eight *)(turn + j);
            fcm_eight a = turn_before * first, b = turn_last * first;
    #pragma GCC unroll 8
            for (int i = 0; i < 8; i++) {
                const fcm_eight x = *(const fcm_eight *)(block + i * width + j);
                a += before[i] * x, b += last[i] * x;
            }
            const fcm_eight sizes[2] = {a * part, b};
            for (int p = 0; p < 2; p++) {
                const fcm_eight_whole size = (fcm_eight_whole)sizes[p] & 0x7fffffffffffffffLL;
                const fcm_eight_whole more = (fcm_eight)size > (fcm_eight)most;
                most = (more & size) | (~more & most);
            }
        }
        double all = 0.0;
        const fcm_eight each = (fcm_eight)most;
        for (int i = 0; i < 8; i++)
            all = all > each[i] ? all : each[i];
        return all;
    }
    #else
    #define fcm_rest_eight(before, last, turn_before, turn_last, part, turn, block, width) (-1.0)
    #define fcm_drive_eight(t, r, slope, rate, e_x, e_y, cosines, sines, order, count, turn, width, moves, block) 0
    #define fcm_weigh_eight(t, weight, speed, reach, e_x, e_y, cosines, sines, place, count, by, into) 0
    #define fcm_carry_eight(inverse, block, width, columns, weight, sums, rows, by, turn) 0
    #endif
    """
    bint drive_eight "fcm_drive_eight"(
        const double *, const double *, const double *, const double *, const double *, const double *,
        const double *, const double *, const double *, int, const double *, Py_ssize_t, int,
        double *) noexcept nogil
    double rest_eight "fcm_rest_eight"(
        const double *, const double *, double, double, double, const double *, const double *,
        Py_ssize_t) noexcept nogil
    bint weigh_eight "fcm_weigh_eight"(
        const double *, const double *, const double *, const double *, const double *, const double *,
        const double *, const double *, const int *, int, double, double *) noexcept nogil
    bint carry_eight "fcm_carry_eight"(
        const double *, const double *, Py_ssize_t, Py_ssize_t, const double *, double *, Py_ssize_t, double,
        double *) noexcept nogil

cdef class PlanarDerivatives(ForceDerivatives):
    cdef readonly Panel panel
    cdef readonly int rows, width
    cdef int low, high
    cdef bint known
    cdef readonly double[::1] turn, w_x, w_y
    cdef double[::1] u_x, u_y, r
    cdef double[:, ::1] block, gathered, weight
    cdef double[::1] slope
    cdef void take(self, int low, int high) noexcept nogil
    cdef void moved(self) noexcept nogil
    cdef void start(self) noexcept nogil
    cdef void slide(self, double e_x, double e_y) noexcept nogil
    cdef void rest(self, double e_x, double e_y) noexcept nogil
    cdef void close(self) noexcept nogil
    cdef void close_sliding(self, double e_x, double e_y, double rate) noexcept nogil
    cdef double greatest(self) noexcept nogil
    cdef double rest_of_turns(self) noexcept nogil
    cdef void carry(self, bint gather) noexcept nogil
    cdef void drive(self) noexcept nogil
    cdef void solve(self, bint gather, double by) noexcept nogil
    cdef void weigh(self) noexcept nogil
    cdef void stick(self, double begin, double end) noexcept nogil
    cdef void direct(self) noexcept nogil
    cdef void settle(self, bint kept) noexcept nogil
