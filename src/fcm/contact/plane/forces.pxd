from fcm.contact.contact_kernel cimport ContactParameters
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

    cdef int evaluate(self, double[::1] x, Py_ssize_t first, ContactParameters contact, bint gradient) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void press(self) noexcept nogil
    cdef void stick_gradient(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_one(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_two(self) noexcept nogil
    cdef void rescale(self, ContactParameters contact, bint gradient) noexcept nogil
