from fcm.contact.periodic.motion cimport Motion
from fcm.contact.periodic.crossings cimport Crossings
from fcm.contact.periodic.cycle cimport Cycle

cdef class Measures:
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly Crossings crossings
    cdef readonly double least_load, greatest_load, overlap, greatest_friction, dissipation, slip_path
    cdef readonly int signature
    cdef double piece_energy, piece_path
    cdef readonly double[::1] value
    cdef double[::1] points, weights, turn_cos, turn_sin
    cdef void measure(self, double k_u) noexcept nogil
    cdef void bear(self, double k_u) noexcept nogil
    cdef void greatest(self) noexcept nogil
    cdef void extremes(self) noexcept nogil
    cdef void friction(self) noexcept nogil
    cdef int piece(self, double theta) noexcept nogil
    cdef double force(self, int p, double theta) noexcept nogil
    cdef void slips(self, double k_u) noexcept nogil
    cdef void slip(self, int p, double length) noexcept nogil
    cdef void sign(self) noexcept nogil
