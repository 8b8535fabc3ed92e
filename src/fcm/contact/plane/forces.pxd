from fcm.contact.contact_kernel cimport ContactKernel
from fcm.contact.plane.cycle cimport PlanarCycle
from fcm.contact.plane.integrals cimport PlanarDerivatives, PlanarIntegrals

cdef class PlanarContact(ContactKernel):
    cdef readonly PlanarCycle cycle
    cdef readonly PlanarIntegrals integrals
    cdef readonly PlanarDerivatives derivatives
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void stick_gradient(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_one(self, double s_x, double s_y) noexcept nogil
    cdef void held_by_two(self) noexcept nogil
