from fcm.contact.plane.motion cimport PlaneMotion
from fcm.contact.plane.panel cimport Panel
from fcm.contact.plane.sums cimport Sums

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
