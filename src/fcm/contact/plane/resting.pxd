from fcm.contact.plane.panel cimport PlaneMotion

cdef class Resting:
    cdef double same
    cdef int exchanges
    cdef readonly PlaneMotion motion
    cdef readonly int nodes, held
    cdef readonly double step, w_x, w_y, overlap, beyond, angle
    cdef double[:, ::1] node_cos, node_sin, at
    cdef double[::1] gap
    cdef readonly double[:, ::1] basis
    cdef double x, y, t
    cdef bint found, sampled
    cdef bint stays(self, double s_x, double s_y) noexcept nogil
    cdef bint encloses(self, bint exact) noexcept nogil
    cdef void nearest(self, double s_x, double s_y) noexcept nogil
    cdef void sharpen(self, double s_x, double s_y) noexcept nogil
    cdef void sharpen_one(self, int i, double w_x, double w_y) noexcept nogil
    cdef void sample(self) noexcept nogil
    cdef void farthest(self, double w_x, double w_y) noexcept nogil
    cdef double outside(self, double theta) noexcept nogil
    cdef void refine(self, double theta) noexcept nogil
    cdef void exchange(self, bint near, double s_x, double s_y) noexcept nogil
    cdef void attempt(self, bint near, double s_x, double s_y, int i, int j) noexcept nogil
    cdef bint fits(self, double x, double y, double t) noexcept nogil
    cdef void consider(self, bint near, double s_x, double s_y, double x, double y, double t, int i, int j) noexcept nogil
    cdef void keep(self, int i) noexcept nogil
    cdef double best
    cdef int best_i, best_j
