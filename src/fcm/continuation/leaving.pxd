from fcm.continuation.front cimport Front
from fcm.continuation.passage cimport Passage
from fcm.continuation.place cimport Place

cdef double before_corner(Front front) except? -1

cdef class Leaving:
    cdef Passage passage
    cdef bint softly
    cdef double[::1] grew
    cdef int at(self, Place place, double length, double past) except -1
    cdef bint peaked(self) noexcept
