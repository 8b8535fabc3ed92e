from fcm.contact.contact_kernel cimport ContactKernel, ContactParameters
from fcm.contact.periodic.motion cimport ZeroCrossings
from fcm.contact.plane.integrals cimport PlanarDerivatives, PlanarIntegrals
from fcm.contact.plane.panel cimport PlaneMotion
from fcm.contact.plane.resting cimport Resting
from fcm.contact.plane.slider cimport Slider

cdef class PlanarCycle:
    cdef double double_point, slight, hardly, inside, fine, next_change, contraction, determinant
    cdef int most_periods
    cdef readonly PlaneMotion motion
    cdef readonly Slider slider
    cdef readonly Resting resting
    cdef readonly ZeroCrossings crossings
    cdef readonly int kind, behaviour, periods
    cdef double moved_x, moved_y, place_x, place_y
    cdef double[:, ::1] side
    cdef int sides, replaced
    cdef int solve(self, int behaviour, double s_x, double s_y, bint gradient) noexcept nogil
    cdef int opening(self, bint gradient) noexcept nogil
    cdef int closed(self, bint gradient) noexcept nogil
    cdef double period(self, double begin, double w_x, double w_y) noexcept nogil
    cdef void gather(self, bint gradient) noexcept nogil
    cdef bint bracket(self, double w_x, double w_y) noexcept nogil
    cdef bint between(self, double w_x, double w_y) noexcept nogil

cdef class PlanarContact(ContactKernel):
    cdef readonly PlanarCycle cycle
    cdef readonly PlanarIntegrals integrals
    cdef readonly PlanarDerivatives derivatives
    cdef void resist(self, ContactParameters contact, double[:, ::1] resistance) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void stick_gradient(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_one(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_two(self) noexcept nogil
