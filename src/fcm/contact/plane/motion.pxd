from fcm.contact.periodic.motion cimport Motion

cdef int X, Y, REACH, LOAD, SCAN, ROWS

cdef class PlaneMotion:
    cdef readonly object options
    cdef double smooth, faint
    cdef readonly Motion normal
    cdef readonly int count, highest, moving, stages
    cdef readonly double scale, load_scale, ratio, preload, mean_x, mean_y, size, reach
    cdef readonly int[::1] number
    cdef readonly double[::1] order, mean, motion_bound, reach_bound
    cdef readonly double[:, ::1] re, im, cos, sin, value
    cdef double[::1] line
    cdef int load(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0) noexcept nogil
    cdef void fill(self, double[::1] x, Py_ssize_t first, double k_u, double k_v) noexcept nogil
    cdef void bound(self) noexcept nogil
    cdef bint rubs(self) noexcept nogil
    cdef void place(self, int slot, double theta) noexcept nogil
    cdef void bend(self, int slot) noexcept nogil
