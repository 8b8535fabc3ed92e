from fcm.contact.periodic.forces cimport PeriodicContact
from fcm.structure.receptance cimport Receptance

cdef class Finer:
    cdef public Receptance seen
    cdef public PeriodicContact kernel
    cdef readonly int contacts, width, wide
    cdef readonly double[::1] x
    cdef readonly double shift
    cdef int[::1] place
    cdef double[:, ::1] contact, force, matrix
    cdef double[::1] spring, coupling, right
    cdef int[::1] swapped
    cpdef int at(self, double[::1] z) except -1
    cdef void unknowns(self, double[::1] z) noexcept
    cdef void resists(self, Py_ssize_t c) noexcept
    cdef void displace(self, Py_ssize_t h) noexcept
    cdef int displace_many(self, int h) except -1
    cdef double added(self, Py_ssize_t c, Py_ssize_t first) noexcept
