cdef (double, double, double, double) normal_load(double n0_star) noexcept nogil
