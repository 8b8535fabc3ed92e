from fcm.continuation.point cimport Point

cdef double FLAT

cdef class Predictor:
    cdef public double[::1] bend
    cdef public double[::1] second
    cdef public double[::1] third
    cdef public bint known
    cdef public bint cubic
    cdef double[::1] way
    cpdef int straighten(self) except -1
    cdef void put(self, Point here, double[::1] scale, double step, double[::1] guess) noexcept
    cdef double rescale(self, Point here, Point point, double[::1] scale, double[::1] new, double length) noexcept
    cdef void learn(self, Point here, Point point, double[::1] scale, double[::1] new, double length) noexcept
    cdef void curve(self, Point here, Point point, double[::1] scale, double[::1] new) noexcept

cdef double along(double[::1] a, double[::1] b) noexcept
