from fcm.contact.contact_kernel cimport ContactParameters, CycleMeasures
from fcm.contact.periodic.cycle cimport LineCycle
from fcm.contact.periodic.motion cimport ZeroCrossings, LineMotion

cdef int CLOSES, OPENS, SLIPS, MOST, LEAST, MINIMUM, MAXIMUM, GREATEST_LOAD
cdef double PAST

cdef class RegimeMargins:
    cdef readonly LineMotion normal
    cdef readonly ZeroCrossings crossings
    cdef readonly int most, count
    cdef readonly double[::1] value, angle
    cdef readonly int[::1] kind
    cdef void find(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef void note(self, int kind, double angle, double value) noexcept nogil
    cdef double squared(self, int kind, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef void loads(self, int behaviour) noexcept nogil

cdef class Margins(RegimeMargins):
    cdef readonly LineCycle cycle
    cdef void slips(self, int kind, int behaviour, double start) noexcept nogil
    cdef void holders(self, int extreme, int kind, double[::1] limit, double side) noexcept nogil

cdef double greatest_load(ZeroCrossings crossings) noexcept nogil

cdef class Measures(CycleMeasures):
    cdef readonly LineMotion motion
    cdef readonly LineCycle cycle
    cdef readonly ZeroCrossings crossings
    cdef readonly double least_load, overlap
    cdef double piece_energy, piece_path
    cdef readonly double[::1] value
    cdef double[::1] points, weights, turn_cos, turn_sin
    cdef void extremes(self) noexcept nogil
    cdef void friction(self) noexcept nogil
    cdef int piece(self, double theta) noexcept nogil
    cdef double force(self, int p, double theta) noexcept nogil
    cdef void slips(self, double k_u) noexcept nogil
    cdef void slip(self, int p, double length) noexcept nogil
