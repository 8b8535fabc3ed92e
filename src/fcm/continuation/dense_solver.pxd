cdef extern from *:
    """
    #include <stddef.h>
    /* Compiled for wider registers, too, where the compiler can have the processor choose. Nothing is
       contracted, so that all processors round alike. */
    #if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
    #define FCM_WIDE __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_WIDE
    #endif

    /* From numbers of four rows a those of four above, u, times by (row of a, of u), one after another. */
    FCM_WIDE static void fcm_subtract(
        double *__restrict a0, double *__restrict a1, double *__restrict a2, double *__restrict a3,
        const double *__restrict u0, const double *__restrict u1, const double *__restrict u2,
        const double *__restrict u3, const double *__restrict by, ptrdiff_t count)
    {
        const double a = by[0], b = by[1], c = by[2], d = by[3], e = by[4], f = by[5], g = by[6], h = by[7],
            i = by[8], k = by[9], l = by[10], m = by[11], n = by[12], o = by[13], p = by[14], q = by[15];
        for (ptrdiff_t j = 0; j < count; j++) {
            const double r = u0[j], s = u1[j], t = u2[j], v = u3[j];
            a0[j] = a0[j] - a * r - b * s - c * t - d * v;
            a1[j] = a1[j] - e * r - f * s - g * t - h * v;
            a2[j] = a2[j] - i * r - k * s - l * t - m * v;
            a3[j] = a3[j] - n * r - o * s - p * t - q * v;
        }
    }

    /* Four rows a, from the column on that belongs to the first of four rows u above, less these. */
    static inline void fcm_four_less_four(double *a, const double *u, ptrdiff_t size, ptrdiff_t columns)
    {
        double by[16];
        for (int r = 0; r < 4; r++) {
            double *x = a + r * size, *y = by + 4 * r;
            y[0] = x[0];
            y[1] = x[1] = x[1] - y[0] * u[1];
            y[2] = x[2] = x[2] - y[0] * u[2] - y[1] * u[size + 2];
            y[3] = x[3] = x[3] - y[0] * u[3] - y[1] * u[size + 3] - y[2] * u[2 * size + 3];
        }
        a += 4, u += 4;
        fcm_subtract(a, a + size, a + 2 * size, a + 3 * size,
                     u, u + size, u + 2 * size, u + 3 * size, by, columns - 4);
    }

    /* Four rows a, from column n on, less four rows u below times what a has in the columns from k on. */
    static inline void fcm_four_less_upper(double *a, const double *u, ptrdiff_t size, ptrdiff_t k, ptrdiff_t n)
    {
        double by[16];
        for (int r = 0; r < 4; r++)
            for (int c = 0; c < 4; c++) by[4 * r + c] = a[r * size + k + c];
        a += n, u += n;
        fcm_subtract(a, a + size, a + 2 * size, a + 3 * size,
                     u, u + size, u + 2 * size, u + 3 * size, by, size - n);
    }
    """
    void four_less_four "fcm_four_less_four"(double *, const double *, Py_ssize_t, Py_ssize_t) noexcept nogil
    void four_less_upper "fcm_four_less_upper"(
        double *, const double *, Py_ssize_t, Py_ssize_t, Py_ssize_t) noexcept nogil

cdef double eliminate(double[:, ::1], int[::1]) noexcept
cdef bint condense(double[:, ::1], int[::1]) noexcept
cdef void substitute(double[:, ::1], int[::1], double[::1]) noexcept

cdef class Solver:
    cdef public int size
    cdef public double[:, ::1] matrix
    cdef public double[::1] right
    cdef int[::1] swapped
    cdef readonly int lapack_size
    cdef public double orientation
    cdef object factors
    cpdef bint factor(self) except -1
    cpdef int solve(self) except -1
