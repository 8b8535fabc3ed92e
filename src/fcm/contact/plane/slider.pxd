from fcm.contact.plane.panel cimport Panel, PlaneMotion
from fcm.contact.plane.integrals cimport PlanarDerivatives, PlanarIntegrals

cdef int STICK, SLIP, SEPARATION

cdef class Slider:
    cdef double shortest, least_step, on_edge, negligible, near, ends, deepest, nothing, light, shrink, grow, safety, varied, unturned
    cdef readonly PlaneMotion motion
    cdef readonly Panel panel
    cdef readonly PlanarIntegrals integrals
    cdef readonly PlanarDerivatives derivatives
    cdef readonly int pieces, capacity, panels, most_panels
    cdef readonly int[::1] state
    cdef readonly double[::1] begin, rest_x, rest_y
    cdef readonly double[:, ::1] record
    cdef readonly double theta, w_x, w_y, e_x, e_y, gone_x, gone_y, gone
    cdef readonly double longest
    cdef double next_length, gap, gap_slope, noise, stalled, first_step, last_x, last_y, last_speed, falls
    cdef public double tolerance
    cdef readonly bint sliding, varying, gathering, gradient, failed
    cdef void add(self, int state) noexcept nogil
    cdef double length(self, int p) noexcept nogil
    cdef void enter(self, double theta, double w_x, double w_y) noexcept nogil
    cdef void close(self, double theta) noexcept nogil
    cdef void advance(self, double end, bint opens) noexcept nogil
    cdef void slide(self, double end, bint opens) noexcept nogil
    cdef double turning(self, int slot, double rate) noexcept nogil
    cdef double scaled(self, double length, double left, double by) noexcept nogil
    cdef double grown(self, double rest) noexcept nogil
    cdef void opening(self, double end) noexcept nogil
    cdef double stray(self) noexcept nogil
    cdef double realign(self, double push) noexcept nogil
    cdef double left_out(self, double stray, double turned, double left) noexcept nogil
    cdef void accept(self, bint carried) noexcept nogil
    cdef void halt(self) noexcept nogil
    cdef void hold(self, double end) noexcept nogil
    cdef double push(self) noexcept nogil
    cdef double first_length(self) noexcept nogil
    cdef void measure(self, double theta) noexcept nogil
    cdef void release(self, double begin, double theta) noexcept nogil
    cdef double meet(self, double low, double high) noexcept nogil
