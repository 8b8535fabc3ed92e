from fcm.continuation.front cimport Front
from fcm.continuation.place cimport Place
from fcm.continuation.trail cimport Trail

cdef class Passage:
    cdef readonly Front front
    cdef readonly Trail trail
    cdef readonly Py_ssize_t n
    cdef readonly double low, high
    cdef readonly bint interior, around
    cdef readonly list values
    cdef readonly object greatest
    cdef double[::1] stops, most
    cdef double[::1] first, head
    cdef bint keep(self, double limit) except -1
    cdef bint been(self) except -1
    cdef int add(self, long mark) except -1
    cdef int note(self, Place place) except -1
    cdef void rise(self) noexcept
    cdef bint closed(self) except -1
    cdef bint inside(self) noexcept
