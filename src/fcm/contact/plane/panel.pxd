from fcm.contact.plane.motion cimport PlaneMotion

cdef class Panel:
    cdef readonly PlaneMotion motion
    cdef readonly int stages
    cdef readonly double theta, length, start_x, start_y, noise
    cdef readonly double[::1] node, weight, tail, bary, tangent, change, rate, e_x, e_y, push, along
    cdef readonly double[:, ::1] slopes
    cdef double[:, ::1] matrix
    cdef double[::1] right
    cdef int[::1] pivot
    cdef bint solve(self, double theta, double length, double e_x, double e_y, double rate) noexcept nogil
    cdef bint newton(self, double start) noexcept nogil
    cdef bint factor(self) noexcept nogil
    cdef void back(self) noexcept nogil
    cdef bint finish(self) noexcept nogil
    cdef double rest(self) noexcept nogil
    cdef double end_of_slip(self) noexcept nogil
    cdef (double, double) pushed(self, double x) noexcept nogil
    cdef double root(self, double low, double high) noexcept nogil
    cdef double lowest(self, double low, double high) noexcept nogil
    cdef double slope_at(self, int j) noexcept nogil
