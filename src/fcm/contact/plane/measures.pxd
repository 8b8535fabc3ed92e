from fcm.contact.periodic.events cimport Crossings
from fcm.contact.plane.cycle cimport Cycle
from fcm.contact.plane.motion cimport PlaneMotion

cdef class PlanarMeasures:
    cdef double invisible, steps
    cdef readonly PlaneMotion motion
    cdef readonly Cycle cycle
    cdef readonly Crossings crossings
    cdef readonly double greatest_load, greatest_friction, dissipation, slip_path
    cdef readonly int pieces
    cdef readonly int[::1] state
    cdef void bear(self, double mu, double k_u) noexcept nogil
    cdef void loads(self) noexcept nogil
    cdef void friction(self) noexcept nogil
    cdef double force(self, int p, double theta) noexcept nogil
    cdef double length(self, int p) noexcept nogil
    cdef void states(self, bint rubs) noexcept nogil
