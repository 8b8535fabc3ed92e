from fcm.stability.disturbance cimport Disturbances
from fcm.stability.state_sequence cimport StateSequence

cdef class Monodromy(Disturbances):
    cdef readonly StateSequence sequence
    cdef int first
    cdef int[::1] memory
    cdef double[:, ::1] port
    cpdef int follow(self, double omega) except -1
    cdef int begin(self) except -1
    cdef int apply_event(self, int e) except -1

cdef class RingMonodromy(Monodromy):
    cdef double part, start
    cdef object renumber, source
    cpdef int follow(self, double omega) except -1
    cdef void widest(self) noexcept

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

    /* p x^T + q y^T is added to a matrix. */
    FCM_WIDE static void fcm_add_two_products(
        double *__restrict matrix, const double *__restrict p, const double *__restrict x,
        const double *__restrict q, const double *__restrict y, ptrdiff_t rows, ptrdiff_t columns)
    {
        for (ptrdiff_t i = 0; i < rows; i++) {
            double *__restrict row = matrix + i * columns;
            const double a = p[i], b = q[i];
            for (ptrdiff_t j = 0; j < columns; j++) row[j] += a * x[j] + b * y[j];
        }
    }

    /* The next terms tq, tv of the series of q, v, with share = h / order: g is pushed with in the first. */
    FCM_WIDE static void fcm_add_term(
        const double *__restrict K, const double *__restrict damping, const double *__restrict g, int first,
        double share, double *__restrict tq, double *__restrict tv, double *__restrict q,
        double *__restrict v, double *__restrict work, ptrdiff_t modes, ptrdiff_t columns)
    {
        for (ptrdiff_t i = 0; i < modes; i++)
            for (ptrdiff_t j = 0; j < columns; j++)
                work[i * columns + j] = (first ? g[i * columns + j] : 0.0) - damping[i] * tv[i * columns + j];
        ptrdiff_t i = 0;
        for (; i + 2 <= modes; i += 2) {  /* two rows at a time, by four */
            const double *k = K + i * modes, *l = k + modes;
            double *__restrict out = work + i * columns, *__restrict next = out + columns;
            ptrdiff_t r = 0;
            for (; r + 4 <= modes; r += 4) {
                const double a = k[r], b = k[r + 1], c = k[r + 2], d = k[r + 3];
                const double e = l[r], f = l[r + 1], h = l[r + 2], m = l[r + 3];
                const double *__restrict s = tq + r * columns, *__restrict t = s + columns,
                    *__restrict x = t + columns, *__restrict y = x + columns;
                for (ptrdiff_t j = 0; j < columns; j++) {
                    out[j] -= (a * s[j] + b * t[j]) + (c * x[j] + d * y[j]);
                    next[j] -= (e * s[j] + f * t[j]) + (h * x[j] + m * y[j]);
                }
            }
            for (; r < modes; r++)
                for (ptrdiff_t j = 0; j < columns; j++) {
                    out[j] -= k[r] * tq[r * columns + j];
                    next[j] -= l[r] * tq[r * columns + j];
                }
        }
        for (; i < modes; i++)
            for (ptrdiff_t r = 0; r < modes; r++)
                for (ptrdiff_t j = 0; j < columns; j++)
                    work[i * columns + j] -= K[i * modes + r] * tq[r * columns + j];
        for (ptrdiff_t j = 0; j < modes * columns; j++) {
            tq[j] = share * tv[j];
            tv[j] = share * work[j];
            q[j] += tq[j];
            v[j] += tv[j];
        }
    }
    """
    void add_two_products "fcm_add_two_products"(
        double *, const double *, const double *, const double *, const double *,
        Py_ssize_t, Py_ssize_t) noexcept nogil
    void add_term "fcm_add_term"(
        const double *, const double *, const double *, int, double, double *, double *, double *, double *,
        double *, Py_ssize_t, Py_ssize_t) noexcept nogil

cdef void add_products(
    double[:, ::1] matrix, double[::1] p, double[::1] x, double[::1] q, double[::1] y) noexcept

cdef class ManyMonodromy:
    cdef public StateSequence sequence
    cdef readonly int modes, contacts, columns, moving, first
    cdef Py_ssize_t pushing
    cdef bint soft, by_modes
    cdef double rate, omega, step_radians, series_tolerance
    cdef object shapes, natural, ratio, following, stiff, static, all_stuck
    cdef public list remembering
    cdef double[:, ::1] contact, K, lower, upper, left, right, changed, pulled, own, weights
    cdef double[:, ::1] q, v, tq, tv, work, g, w, phi, port, followed, row
    cdef double[::1] damping, push
    cdef int[::1] state, number
    cpdef int follow(self, double omega) except -1
    cdef int apply_event(self, int e) except -1
    cdef int find_products(self, Py_ssize_t one) except -1
    cdef double flexibility(self, Py_ssize_t r, Py_ssize_t at) noexcept
    cdef void find_rate(self) noexcept
    cdef void propagate(self, double length) noexcept
    cdef void apply(self, double h) noexcept
