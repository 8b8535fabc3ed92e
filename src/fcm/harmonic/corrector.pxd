from fcm.harmonic.further cimport Further
from fcm.harmonic.lifted cimport Lifted

cdef class Corrector:
    cdef readonly object system
    cdef readonly Further further
    cdef readonly int count
    cdef readonly bint cheap
    cdef readonly dict known
    cdef bint again
    cdef double enough
    cdef list lifts
    cdef list sets
    cdef dict second
    cdef dict spare
    cdef dict spares
    cdef unsigned char[:, ::1] covers
    cdef double[::1] top, found
    cdef Py_ssize_t[::1] place
    cdef Py_ssize_t among
    cdef Py_ssize_t choose(self, bint best) except -2
    cdef Py_ssize_t covering(self) noexcept
    cdef void rank(self) noexcept
    cdef bint put(self, Py_ssize_t k, double[::1] z, double[::1] direction, double[::1] amplitude) except -1
    cdef int twice(self, Py_ssize_t k) except -1
