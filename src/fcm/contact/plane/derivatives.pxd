from fcm.contact.plane.motion cimport PlaneMotion
from fcm.contact.plane.panel cimport Panel
from fcm.contact.plane.sums cimport Sums

cdef class Derivatives:
    cdef readonly PlaneMotion motion
    cdef readonly Panel panel
    cdef readonly Sums sums
    cdef readonly int outputs, unknowns
    cdef int low, high
    cdef readonly int[::1] output
    cdef readonly double[:, ::1] jacobian
    cdef readonly double[::1] turn, w_x, w_y
    cdef double[::1] u_x, u_y, r
    cdef double[:, ::1] block
    cdef void fill(self, double value) noexcept nogil
    cdef void take(self, int low, int high) noexcept nogil
    cdef void moved(self) noexcept nogil
    cdef void start(self) noexcept nogil
    cdef void slide(self, double e_x, double e_y) noexcept nogil
    cdef void rest(self, double e_x, double e_y) noexcept nogil
    cdef void close(self) noexcept nogil
    cdef void close_sliding(self, double e_x, double e_y, double rate) noexcept nogil
    cdef void carry(self, bint gather) noexcept nogil
    cdef void solve(self) noexcept nogil
    cdef void gather(self) noexcept nogil
    cdef void stick(self, double begin, double end) noexcept nogil
    cdef void direct(self) noexcept nogil
    cdef void row(self, Py_ssize_t row, int rows, int h, int which, int part, double factor) noexcept nogil
    cdef void settle(self, bint kept) noexcept nogil
    cdef void rescale(self, int row, double by_motion, double by_load) noexcept nogil
