from fcm.contact.periodic.motion cimport Motion
from fcm.contact.periodic.cycle cimport Cycle
from fcm.contact.periodic.integrals cimport Integrals
from fcm.contact.periodic.derivatives cimport Derivatives

cdef class PeriodicContact:
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly Integrals integrals
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
        double start,
        bint gradient,
    ) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void rescale(self, double mu, double k_u, double k_v, bint gradient) noexcept nogil
