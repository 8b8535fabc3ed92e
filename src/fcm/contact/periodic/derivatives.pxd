from fcm.contact.periodic.motion cimport Motion
from fcm.contact.periodic.cycle cimport Cycle
from fcm.contact.periodic.integrals cimport Integrals

cdef class Derivatives:
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly Integrals integrals
    cdef readonly int outputs, unknowns
    cdef readonly int[::1] output
    cdef readonly double[:, ::1] jacobian
    cdef double[::1] memory

    cdef void fill(self, double value) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void block(
        self, Py_ssize_t row, int of_load, int rows, int h, int which, double factor
    ) noexcept nogil
    cdef void gradient(self, int p) noexcept nogil
    cdef void remember_all(self) noexcept nogil
    cdef void remember(self, int p) noexcept nogil
    cdef void rescale(self, int row, double by_motion, double by_load) noexcept nogil
