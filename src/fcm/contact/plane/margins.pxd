from fcm.contact.contact_kernel cimport ContactParameters, CycleMeasures
from fcm.contact.periodic.margins cimport RegimeMargins
from fcm.contact.periodic.motion cimport ZeroCrossings
from fcm.contact.plane.cycle cimport PlanarCycle
from fcm.contact.plane.panel cimport PlaneMotion
from fcm.contact.plane.resting cimport Resting

cdef class PlanarMargins(RegimeMargins):
    cdef double steps
    cdef readonly PlaneMotion motion
    cdef readonly PlanarCycle cycle
    cdef readonly Resting resting
    cdef void hold(self, double[::1] x, Py_ssize_t first, ContactParameters contact, bint start) noexcept nogil
    cdef void rests(self, double s_x, double s_y) noexcept nogil
    cdef double other(self) noexcept nogil
    cdef double weaker(self, double s_x, double s_y) noexcept nogil
    cdef void pushes(self) noexcept nogil
    cdef void within(self, int p, double end) noexcept nogil
    cdef double outside(self, int p, double theta) noexcept nogil

cdef class PlanarMeasures(CycleMeasures):
    cdef double invisible, steps, growth
    cdef readonly PlaneMotion motion
    cdef readonly PlanarCycle cycle
    cdef readonly ZeroCrossings crossings
    cdef int[::1] piece
    cdef void loads(self) noexcept nogil
    cdef void friction(self) noexcept nogil
    cdef double top(self, int p, double low, double high, double before) noexcept nogil
    cdef double force(self, int p, double theta) noexcept nogil
    cdef void states(self, bint rubs) noexcept nogil
