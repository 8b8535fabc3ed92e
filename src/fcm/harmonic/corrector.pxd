from fcm.harmonic.further cimport Further
from fcm.harmonic.lifted cimport Lifted
from fcm.harmonic.ranking cimport Ranking

cdef class Corrector:
    cdef readonly object system
    cdef readonly Ranking ranking
    cdef readonly Further further
    cdef bint again
    cdef double fruitless
    cdef double enough
    cdef int most
    cdef list lifts
    cdef dict second
    cdef dict spare
    cdef dict spares
    cdef double[::1] found
    cdef Lifted of_set(self, Py_ssize_t k)
    cdef bint put(self, Py_ssize_t k, double[::1] z, double[::1] direction, double[::1] amplitude, bint best) except -1
    cdef int twice(self, Py_ssize_t k, bint best) except -1
