cdef class CoefficientLaw:
    cdef void evaluate(
        self, double n0_bar, double b_bar, double phi, bint gradient, double[::1] out, Py_ssize_t at
    ) noexcept nogil
    cdef void unknown(self, bint gradient, double[::1] out, Py_ssize_t at) noexcept nogil
    cdef bint _fill(
        self,
        const double[::1] n0_bar,
        const double[::1] b_bar,
        const double[::1] phi,
        bint gradient,
        double[::1] out,
        Py_ssize_t numbers,
    ) noexcept
