cdef class Cubic:
    cdef const float[::1] coefficients
    cdef Py_ssize_t step_u, step_x, last
    cdef void evaluate(
        self, double u, double x, double z, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil

cdef (double, double, double, double) weights(double f) noexcept nogil
cdef (double, double, double, double) slopes(double f) noexcept nogil
