from fcm.contact.plane.panel cimport PlaneMotion

cdef double FAR

cdef class Resting:
    cdef double same, least_bend
    cdef int exchanges, max_halvings
    cdef readonly PlaneMotion motion
    cdef readonly int nodes, held
    cdef readonly double step, w_x, w_y, overlap, beyond, angle
    cdef double[:, ::1] node_cos, node_sin, at
    cdef double[::1] gap, square
    cdef double[:, ::1] stack
    cdef readonly double[:, ::1] basis
    cdef double x, y, t, level, fourth, noise, rounding, but
    cdef bint found, sampled
    cdef bint stays(self, double s_x, double s_y) noexcept nogil
    cdef bint encloses(self, bint exact) noexcept nogil
    cdef bint brief(self) noexcept nogil
    cdef void nearest(self, double s_x, double s_y) noexcept nogil
    cdef void sharpen(self, double s_x, double s_y) noexcept nogil
    cdef void sharpen_one(self, int i, double w_x, double w_y) noexcept nogil
    cdef void sample(self) noexcept nogil
    cdef void farthest(self, double w_x, double w_y) noexcept nogil
    cdef void farthest_of_all(self, double w_x, double w_y) noexcept nogil
    cdef void next_farthest(self) noexcept nogil
    cdef void hidden(self, double level) noexcept nogil
    cdef void maxima(self, double level, double least, double but) noexcept nogil
    cdef void between(self, double begin, double least) noexcept nogil
    cdef int most_maxima(self, double length, double g_0, double d_0, double g_1, double d_1, double least) noexcept nogil
    cdef (double, double, double) missed(self, double theta) noexcept nogil
    cdef void peak(self, double low, double high) noexcept nogil
    cdef bint within(self, double first, double last) noexcept nogil
    cdef double outside(self, double theta) noexcept nogil
    cdef void refine(self, double theta) noexcept nogil
    cdef void exchange(self, bint near, double s_x, double s_y) noexcept nogil
    cdef void attempt(self, int i, int j) noexcept nogil
    cdef bint fits(self, double x, double y, double t) noexcept nogil
    cdef void consider(self, double x, double y, double t) noexcept nogil
    cdef void keep(self, int i) noexcept nogil
    cdef bint near
    cdef double s_x, s_y, best
    cdef int i, j, best_i, best_j
