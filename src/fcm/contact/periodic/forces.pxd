from fcm.contact.periodic.motion cimport Motion
from fcm.contact.periodic.cycle cimport Cycle
from fcm.contact.periodic.integrals cimport Integrals

cdef class PeriodicContact:
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly Integrals integrals
    cdef readonly int kind, outputs, unknowns, equations
    cdef readonly int[::1] output
    cdef readonly double[::1] forces
    cdef readonly double[:, ::1] jacobian
    cdef double[::1] memory
    cdef int evaluate(self, double[::1] x, Py_ssize_t first, double mu, double k_u, double k_v, double n_0, double start, bint derivatives) noexcept nogil
    cdef void stuck(self, bint derivatives) noexcept nogil
    cdef void assemble(self, bint derivatives) noexcept nogil
    cdef void block(self, Py_ssize_t row, int of_load, int rows, int h, int which, double factor) noexcept nogil
    cdef void gradient(self, int p) noexcept nogil
    cdef void remember_all(self) noexcept nogil
    cdef void remember(self, int p) noexcept nogil
    cdef void rescale(self, bint derivatives, double mu, double k_u, double k_v) noexcept nogil
    cdef void rescale_row(self, int row, double by_motion, double by_load) noexcept nogil
