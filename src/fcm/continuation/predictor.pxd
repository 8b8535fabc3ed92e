from fcm.continuation.problem cimport Point


cdef class Predictor:
    cdef public double min_cosine
    cdef public double[::1] curvature
    cdef public double[::1] second
    cdef public double[::1] third
    cdef public bint has_cubic
    cdef public bint cubic
    cdef double[::1] direction
    cpdef int reset(self) except -1
    cdef void predict(self, Point here, double[::1] scale, double step, double[::1] guess) noexcept
    cdef double rescale(self, Point here, Point point, double[::1] scale, double[::1] new, double length) noexcept
    cdef void update(self, Point here, Point point, double[::1] scale, double[::1] new, double length) noexcept
    cdef void fit_cubic(self, Point here, Point point, double[::1] scale, double[::1] new) noexcept

cdef double dot(double[::1] a, double[::1] b) noexcept
