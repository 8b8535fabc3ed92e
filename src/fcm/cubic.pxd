cdef double cubic(double before, double after, double begin, double end, double unit, double x) noexcept nogil
cpdef (double, double) powers(double rise, double begin, double end) noexcept nogil
cdef (double, double) value_bounds(double length, double fourth, double g_0, double d_0, double g_1, double d_1) noexcept nogil
cdef (double, double) slope_bounds(double length, double fourth, double g_0, double d_0, double g_1, double d_1) noexcept nogil
cdef double greatest_bend(double length, double fourth, double g_0, double d_0, double g_1, double d_1) noexcept nogil
cdef double middle_slope(double length, double g_0, double d_0, double g_1, double d_1) noexcept nogil
cdef double VALUE_ERROR, SLOPE_ERROR, BEND_ERROR
