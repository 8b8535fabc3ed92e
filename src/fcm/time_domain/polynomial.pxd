cdef double value(double[::1] powers, int order, double x) noexcept nogil
cdef double root(double[::1] powers, int order, double low, double high) noexcept nogil
cdef int needed(double x) noexcept nogil
cdef void summed(double[:, ::1] terms, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil
