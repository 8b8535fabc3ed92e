from fcm.contact.plane.panel cimport PlaneMotion
from fcm.contact.plane.cycle cimport PlanarCycle
from fcm.contact.plane.integrals cimport Derivatives, Sums

cdef class PlanarContact:
    cdef readonly PlaneMotion motion
    cdef readonly PlanarCycle cycle
    cdef readonly Sums sums
    cdef readonly Derivatives derivatives
    cdef readonly int kind, outputs, unknowns, equations
    cdef readonly int[::1] output
    cdef readonly double[::1] forces
    cdef readonly double[:, ::1] jacobian

    cdef int evaluate(
        self,
        double[::1] x,
        Py_ssize_t first,
        double mu,
        double k_u,
        double k_v,
        double n_0,
        double start_x,
        double start_y,
        bint gradient,
    ) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void press(self) noexcept nogil
    cdef void stick_gradient(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_one(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_two(self) noexcept nogil
    cdef void rescale(self, double mu, double k_u, double k_v, bint gradient) noexcept nogil
