from fcm.continuation.dense_solver cimport Solver
from fcm.structure.receptance cimport Receptance

cdef extern from *:
    """
    #include <stddef.h>
    /* Compiled for wider registers, too, where the compiler can have the processor choose. Nothing is
       contracted, so that all processors round alike. */
    #ifndef FCM_WIDE
    #if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
    #define FCM_WIDE __attribute__((unused, target_clones("avx512f", "avx2", "default")))
    #else
    #define FCM_WIDE
    #endif
    #endif

    /* The sum of rows of a matrix, each times a number by, four at a time. */
    FCM_WIDE static void fcm_sum_of_rows(
        double *__restrict out, const double *__restrict by, const double *__restrict matrix,
        ptrdiff_t rows, ptrdiff_t columns)
    {
        ptrdiff_t r = 0;
        for (ptrdiff_t j = 0; j < columns; j++) out[j] = 0.0;
        for (; r + 4 <= rows; r += 4) {
            const double a = by[r], b = by[r + 1], c = by[r + 2], d = by[r + 3];
            const double *__restrict p = matrix + r * columns, *__restrict q = p + columns,
                *__restrict s = q + columns, *__restrict t = s + columns;
            for (ptrdiff_t j = 0; j < columns; j++) out[j] += (a * p[j] + b * q[j]) + (c * s[j] + d * t[j]);
        }
        for (; r < rows; r++) {
            const double a = by[r];
            const double *__restrict p = matrix + r * columns;
            for (ptrdiff_t j = 0; j < columns; j++) out[j] += a * p[j];
        }
    }

    /* The same for several rows of by, two at a time, so that the matrix is read once. */
    FCM_WIDE static void fcm_sums_of_rows(
        double *__restrict out, const double *__restrict by, const double *__restrict matrix,
        ptrdiff_t parts, ptrdiff_t rows, ptrdiff_t columns)
    {
        ptrdiff_t r = 0;
        for (ptrdiff_t j = 0; j < parts * columns; j++) out[j] = 0.0;
        for (; r + 4 <= rows; r += 4) {
            const double *__restrict p = matrix + r * columns, *__restrict q = p + columns,
                *__restrict s = q + columns, *__restrict t = s + columns;
            ptrdiff_t k = 0;
            for (; k + 2 <= parts; k += 2) {
                const double *f = by + k * rows + r, *g = f + rows;
                const double a = f[0], b = f[1], c = f[2], d = f[3], e = g[0], h = g[1], l = g[2], m = g[3];
                double *__restrict x = out + k * columns, *__restrict y = x + columns;
                for (ptrdiff_t j = 0; j < columns; j++) {
                    x[j] += (a * p[j] + b * q[j]) + (c * s[j] + d * t[j]);
                    y[j] += (e * p[j] + h * q[j]) + (l * s[j] + m * t[j]);
                }
            }
            for (; k < parts; k++) {
                const double *f = by + k * rows + r;
                const double a = f[0], b = f[1], c = f[2], d = f[3];
                double *__restrict x = out + k * columns;
                for (ptrdiff_t j = 0; j < columns; j++)
                    x[j] += (a * p[j] + b * q[j]) + (c * s[j] + d * t[j]);
            }
        }
        for (; r < rows; r++)
            for (ptrdiff_t k = 0; k < parts; k++) {
                const double a = by[k * rows + r];
                const double *__restrict p = matrix + r * columns;
                double *__restrict x = out + k * columns;
                for (ptrdiff_t j = 0; j < columns; j++) x[j] += a * p[j];
            }
    }
    """
    void add_rows "fcm_sum_of_rows"(
        double *, const double *, const double *, Py_ssize_t, Py_ssize_t) noexcept nogil
    void add_rows_of_several "fcm_sums_of_rows"(
        double *, const double *, const double *, Py_ssize_t, Py_ssize_t, Py_ssize_t) noexcept nogil

cdef void sum_of_rows(double[::1] by, double[:, ::1] matrix, double[::1] out) noexcept
cdef void sums_of_rows(double[:, ::1] by, double[:, ::1] matrix, double[:, ::1] out) noexcept

cdef class ModalCompliance:
    cdef public Receptance receptance
    cdef public object place
    cdef public double[:, ::1] flexibility
    cdef public double[:, ::1] shapes
    cdef public double[:, ::1] by_port
    cdef public int parts
    cdef bint diagonal
    cdef public Py_ssize_t[:, ::1] at
    cdef double[:, ::1] on_ports
    cdef double[:, ::1] on_modes
    cdef double[:, ::1] moved
    cdef double[::1] mean
    cpdef int displace(self, double[::1] force, double[::1] out) except -1
    cpdef int rate(self, double[::1] force, double[::1] out) except -1
    cdef void collect(self, double[::1] force) noexcept
    cdef void means(self) noexcept
    cdef void apply_compliance(self, double[:, ::1] re, double[:, ::1] im) noexcept
    cdef void spread(self, double[::1] out) noexcept

cpdef int linear_contacts(
    double[:, :, ::1] tangent, Py_ssize_t[::1] order, double[:, :, ::1] linear, double[::1] slight,
    unsigned char[::1] found) except -1

cdef class ModalEquations:
    cdef public ModalCompliance answer
    cdef public object held
    cdef public int modes
    cdef public int rank
    cdef readonly double turned
    cdef int contacts
    cdef int width
    cdef int each
    cdef int parts
    cdef double[:, :, ::1] tangent
    cdef Py_ssize_t[:, ::1] order
    cdef object sums
    cdef object chosen
    cdef double[::1] row
    cdef double[::1] by
    cdef double[::1] scale
    cdef Py_ssize_t[::1] which
    cdef double[:, ::1] shapes
    cdef double[:, ::1] by_port
    cdef double[:, ::1] mean
    cdef Solver solver
    cdef double[:, :, :, ::1] by_mode
    cdef double[:, :, ::1] on_modes
    cdef double[:, ::1] on_ports
    cdef double[:, ::1] pushed
    cdef double[:, ::1] answered
    cdef double[:, ::1] moved
    cdef double[::1] force
    cdef double[::1] whole
    cdef double[:, ::1] basis
    cdef double[:, ::1] R
    cdef double[::1] cosine
    cdef double[::1] sine
    cdef double[::1] reduced
    cpdef int set_closing_row(self, double[::1] row, double[::1] by, double[::1] scale) except -1
    cpdef double factor(self) except -2.0
    cpdef int condensed(self, double[::1] right, double[::1] out) except -1
    cpdef int multiply(self, double[::1] x, double[::1] out) except -1
    cpdef double correct(self, double[::1] right, double[::1] found, double enough, int most) except -1.0
    cdef int by_modes(self) except -1
    cdef void forces(self, double[::1] x) noexcept
    cdef void forces_on_modes(self) noexcept
    cdef void respond(self, double[::1] out) noexcept
    cdef double krylov(self, int k) except -1.0
