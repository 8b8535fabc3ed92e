from fcm.contact.periodic.motion cimport Motion
from fcm.contact.periodic.crossings cimport Crossings
from fcm.contact.periodic.cycle cimport Cycle

cdef class Margins:
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly Crossings crossings
    cdef readonly int most, count
    cdef readonly double[::1] value, angle
    cdef readonly int[::1] kind
    cdef void find(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0) noexcept nogil
    cdef void note(self, int kind, double angle, double value) noexcept nogil
    cdef void loads(self, int behaviour) noexcept nogil
    cdef void slips(self, int kind, int behaviour, double start) noexcept nogil
    cdef void holders(self, int extreme, int kind, double[::1] limit, double side) noexcept nogil
