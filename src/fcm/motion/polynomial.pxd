cdef double value(double[::1] powers, int order, double x) noexcept nogil
cdef double root(double[::1] powers, int order, double low, double high) noexcept nogil
