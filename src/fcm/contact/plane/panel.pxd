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

    /* Gaussian elimination of a matrix (8, 8), which becomes its factors, the diagonal inverted, and of x.
       Without pivots: a rule's derivatives, and positive numbers along the diagonal, have none that vanish. */
    FCM_WIDEST static int fcm_eliminate_eight(double *matrix, double *x)
    {
        fcm_eight row[8];
        double lower[64], y[8];
    #pragma GCC unroll 8
        for (int i = 0; i < 8; i++)
            row[i] = *(const fcm_eight *)(matrix + 8 * i), y[i] = x[i];
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
    #define fcm_eliminate_eight(matrix, x) (-1)
    #endif
    """
    int eliminate_eight "fcm_eliminate_eight"(double *, double *) noexcept nogil

cdef enum:
    STAGES = 8  # as radau.py says in Python

cdef class Panel:
    cdef double converged, steepest, widest, before, growth
    cdef int most_steps
    cdef readonly PlaneMotion motion
    cdef readonly double theta, length, left, fade, start_x, start_y, noise
    cdef readonly double[::1] node, weight, bary, tangent, change, rate, e_x, e_y, push, along, speed
    cdef readonly double[:, ::1] slopes, tail
    cdef double matrix[64]
    cdef double inner[64]
    cdef double right[8]
    cdef double a[8]
    cdef double b[8]
    cdef double r[8]
    cdef (double, double) gone(self, double part) noexcept nogil
    cdef bint solve(self, double theta, double length, double left, double e_x, double e_y, double rate, double bend) noexcept nogil
    cdef bint newton(self, double slope, double bend) noexcept nogil
    cdef bint refresh(self) noexcept nogil
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
