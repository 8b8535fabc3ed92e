from fcm.contact.plane.motion cimport PlaneMotion

cdef extern from *:
    """
    #include <stddef.h>
    /* Eight nodes are a register of eight numbers, or four, or two: compiled for each where the compiler can
       have the processor choose. Nothing is contracted, so that all processors round alike. */
    #if defined(__GNUC__)
    #define FCM_EIGHT
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));
    #if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__)
    #define FCM_WIDEST __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_WIDEST __attribute__((unused))
    #endif

    /* The equation r D t = b - 2 a t - b t^2 at eight nodes: its derivatives by t, a matrix (8, 8), become
       their factors, the diagonal inverted, and x the step of Newton's method. The derivatives D of a
       polynomial are by rows and by columns. Without pivots: of a rule's derivatives, and positive numbers
       along the diagonal, none vanishes. */
    FCM_WIDEST static int fcm_newton_eight(
        const double *rows, const double *columns, const double *r, const double *a, const double *b,
        const double *t, double *matrix, double *x)
    {
        fcm_eight row[8], slope = *(const fcm_eight *)columns * t[0];
        const fcm_eight R = *(const fcm_eight *)r, A = *(const fcm_eight *)a, B = *(const fcm_eight *)b;
        const fcm_eight T = *(const fcm_eight *)t, across = A + B * T;
        double lower[64], y[8], own[8];
    #pragma GCC unroll 8
        for (int j = 1; j < 8; j++)
            slope += *(const fcm_eight *)(columns + 8 * j) * t[j];
        *(fcm_eight *)y = B - T * (A + across) - R * slope;
        *(fcm_eight *)own = 2.0 * across;
    #pragma GCC unroll 8
        for (int i = 0; i < 8; i++) {
            row[i] = r[i] * *(const fcm_eight *)(rows + 8 * i);
            row[i][i] += own[i];
        }
    #pragma GCC unroll 8
        for (int k = 0; k < 8; k++) {
            const double pivot = row[k][k];
            if (!(pivot > 1e-300 || pivot < -1e-300))
                return 0;
            const double by = 1.0 / pivot;
            lower[9 * k] = by;
    #pragma GCC unroll 8
            for (int i = k + 1; i < 8; i++) {
                const double part = row[i][k] * by;
                lower[8 * i + k] = part;
                row[i] -= part * row[k];
                y[i] -= part * y[k];
            }
        }
    #pragma GCC unroll 8
        for (int i = 0; i < 8; i++) {
            *(fcm_eight *)(matrix + 8 * i) = row[i];
    #pragma GCC unroll 8
            for (int k = 0; k <= i; k++)
                matrix[8 * i + k] = lower[8 * i + k];
        }
    #pragma GCC unroll 8
        for (int k = 7; k >= 0; k--) {
            x[k] = y[k] = y[k] * lower[9 * k];
    #pragma GCC unroll 8
            for (int i = 0; i < k; i++)
                y[i] -= row[i][k] * y[k];
        }
        return 1;
    }
    #else
    #define fcm_newton_eight(rows, columns, r, a, b, t, matrix, x) (-1)
    #endif
    """
    int newton_eight "fcm_newton_eight"(
        const double *, const double *, const double *, const double *, const double *, const double *, double *,
        double *) noexcept nogil

cdef enum:
    STAGES = 8  # as radau.py says in Python

cdef class Panel:
    cdef double converged, settled, steepest, widest, before, growth
    cdef int most_steps
    cdef readonly PlaneMotion motion
    cdef readonly double theta, length, left, fade, start_x, start_y, noise
    cdef readonly double[::1] node, weight, bary, tangent, change, rate, e_x, e_y, push, along, speed
    cdef readonly double[:, ::1] slopes, tail
    cdef double matrix[64]
    cdef double inner[64]
    cdef double rows[64]
    cdef double at[8]
    cdef double right[8]
    cdef double a[8]
    cdef double b[8]
    cdef double r[8]
    cdef (double, double) gone(self, double part) noexcept nogil
    cdef bint solve(self, double theta, double length, double left, double e_x, double e_y, double rate, double bend) noexcept nogil
    cdef bint newton(self, double slope, double bend) noexcept nogil
    cdef bint improve(self) noexcept nogil
    cdef void residual(self) noexcept nogil
    cdef bint eliminate(self) noexcept nogil
    cdef bint finish(self) noexcept nogil
    cdef double rest(self) noexcept nogil
    cdef double rest_of_variation(self) noexcept nogil
    cdef double end_of_slip(self) noexcept nogil
    cdef (double, double) pushed(self, double x) noexcept nogil
    cdef double root(self, double low, double high) noexcept nogil
    cdef double lowest(self, double low, double high) noexcept nogil
    cdef double slope_at(self, int j) noexcept nogil
