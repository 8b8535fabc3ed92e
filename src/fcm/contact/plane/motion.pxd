from fcm.contact.periodic.motion cimport Motion

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
       pi / 4 of a multiple of pi / 2, that in three parts. Then the harmonics, and U_x, U_y, R with their
       derivatives, by columns of value (8, 11) and of cosine and sine (8, stride); amplitudes are rows of
       re, im (3.., stride). Nothing is contracted, so that all processors round alike. */
    FCM_PLACE static int fcm_place_eight(
        const double *angle, const double *re, const double *im, const int *number, int moving, ptrdiff_t stride,
        double mean, double *value, double *cosines, double *sines)
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
            for (int i = 0; i < 8; i++)
                cosines[i * stride + k] = a[i], sines[i * stride + k] = b[i];
            for (int row = 0; row < 3; row++) {
                const double p = re[row * stride + k], q = im[row * stride + k];
                sums[row] += p * a - q * b;
                sums[3 + row] -= (double)h * (p * b + q * a);
            }
        }
        for (int i = 0; i < 8; i++, value += 11) {
            for (int row = 0; row < 6; row++)
                value[row] = sums[row][i];
            value[9] = c_1[i], value[10] = s_1[i];
        }
        return 1;
    }
    #else
    #define fcm_place_eight(angle, re, im, number, moving, stride, mean, value, cosines, sines) 0
    #endif
    """
    bint place_eight "fcm_place_eight"(
        const double *, const double *, const double *, const int *, int, Py_ssize_t, double, double *, double *,
        double *) noexcept nogil

cdef int X, Y, REACH, LOAD, SCAN, ROWS

cdef class PlaneMotion:
    cdef readonly object options
    cdef double smooth, faint
    cdef readonly Motion normal
    cdef readonly int count, highest, moving, stages
    cdef readonly double scale, load_scale, ratio, preload, mean_x, mean_y, size, reach
    cdef readonly int[::1] number
    cdef readonly double[::1] order, mean, motion_bound, reach_bound
    cdef readonly double[:, ::1] re, im, cos, sin, value
    cdef double[::1] line
    cdef int load(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0) noexcept nogil
    cdef void fill(self, double[::1] x, Py_ssize_t first, double k_u, double k_v) noexcept nogil
    cdef void bound(self) noexcept nogil
    cdef bint rubs(self) noexcept nogil
    cdef void place(self, int slot, double theta) noexcept nogil
    cdef void place_nodes(self, double *theta) noexcept nogil
    cdef void bend(self, int slot) noexcept nogil
