from fcm.time_domain.flow cimport Flows
from fcm.time_domain.segments cimport Segments

cdef extern from *:
    """
    #include <stddef.h>
    /* Compiled for wider registers where the compiler can have the processor choose: sums of eight columns of
       four rows then stay in registers. Nothing is contracted, so that all processors round alike. */
    #if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
    typedef double fcm_eight __attribute__((vector_size(64), aligned(8)));

    __attribute__((target_clones("avx512f", "avx2", "default")))
    static void fcm_four_times(
        const double *a, ptrdiff_t stride, const double *__restrict matrix, ptrdiff_t n, double *__restrict room)
    {
        const double *b = a + stride, *c = b + stride, *d = c + stride;
        for (ptrdiff_t i = 0;; i = i + 16 <= n ? i + 8 : n - 8) {
            fcm_eight s = {0.0}, t = {0.0}, u = {0.0}, v = {0.0};
            for (ptrdiff_t p = 0; p < n; p++) {
                const fcm_eight x = *(const fcm_eight *)(matrix + p * n + i);
                s += x * a[p], t += x * b[p], u += x * c[p], v += x * d[p];
            }
            *(fcm_eight *)(room + i) = s, *(fcm_eight *)(room + n + i) = t;
            *(fcm_eight *)(room + 2 * n + i) = u, *(fcm_eight *)(room + 3 * n + i) = v;
            if (i == n - 8)
                return;
        }
    }

    /* Of so many rows, as many by four as there are become n of their numbers times a matrix (n, n); returns
       how many. None where registers are too narrow for that to be any faster. */
    static inline ptrdiff_t fcm_fours_times(
        double *rows, ptrdiff_t stride, ptrdiff_t count, const double *matrix, ptrdiff_t n, double *room)
    {
        ptrdiff_t k = 0;
        if (n >= 8 && __builtin_cpu_supports("avx2"))
            for (; k + 4 <= count; k += 4) {
                double *row = rows + k * stride;
                fcm_four_times(row, stride, matrix, n, room);
                for (int r = 0; r < 4; r++)
                    for (ptrdiff_t i = 0; i < n; i++)
                        row[r * stride + i] = room[r * n + i];
            }
        return k;
    }
    #else
    #define fcm_fours_times(rows, stride, count, matrix, n, room) 0
    #endif
    """
    Py_ssize_t fours_times "fcm_fours_times"(
        double *, Py_ssize_t, Py_ssize_t, const double *, Py_ssize_t, double *) noexcept nogil

cdef class VariationalFlow:
    cdef readonly Flows flows
    cdef readonly Py_ssize_t unknowns
    cdef readonly double[:, ::1] columns
    cdef readonly double paced
    cdef double[::1] _flat
    cdef double[:, ::1] _terms, _grades, _room, _matrix
    cdef int follow(self, Py_ssize_t slot, double position) except -1 nogil
    cdef int _whole(self, Py_ssize_t slot, Py_ssize_t j) except -1 nogil
    cdef void _rotate(self, Py_ssize_t h, double c, double s, double time) noexcept nogil
    cdef int _times(self, double[:, ::1] matrix, Py_ssize_t rows) except -1 nogil
    cdef void _row_times(self, double[:, ::1] matrix, Py_ssize_t k) noexcept nogil
    cdef int _fraction(self, Py_ssize_t slot, double x, Py_ssize_t orders) except -1 nogil
    cdef int _part(self, Py_ssize_t slot, double x) except -1 nogil

cdef class Derivative(VariationalFlow):
    cdef readonly Py_ssize_t at
    cdef readonly double position
    cdef readonly double[::1] rate
    cdef double[:, ::1] _rates
    cdef void _stand(self, Segments segments) noexcept nogil
    cdef Py_ssize_t _go(self, Segments segments, Py_ssize_t last, double position) except -2 nogil
    cdef Py_ssize_t _reach(self, Segments segments, Py_ssize_t last, double position) except -2 nogil
    cdef int _arrive(self, Segments segments, Py_ssize_t slot) except -1 nogil
    cdef void _across(self, Segments segments, Py_ssize_t i, Py_ssize_t old, Py_ssize_t new) noexcept nogil
    cdef void _put_friction(self, double[:, ::1] z, Py_ssize_t k, Segments segments, Py_ssize_t i, bint every) noexcept nogil

cdef class Directional(Derivative):
    cdef readonly double pace
    cdef readonly Py_ssize_t done
    cdef double[:, ::1] _series, _angle
    cdef Py_ssize_t _at_places(self, Segments segments, double[:, ::1] places, double[:, ::1] out) except -2 nogil
    cdef void _expand(self, Py_ssize_t slot) noexcept nogil
    cdef void _sum(self, double x, double[:, ::1] out) noexcept nogil
