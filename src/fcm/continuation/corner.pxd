from fcm.continuation.front cimport Front
from fcm.continuation.place cimport Place

cpdef int come(Front front, Place place, double at) except -1
cpdef bint cross(Front front, double[::1] stops) except -1
cpdef bint cross_softly(Front front, double past) except -1
cdef void aim(Front front, double past) noexcept
cdef bint leaves(Front front, double length) except -1
cdef bint onwards(Front front, double length) except -1
cdef bint passes(Front front, double[::1] stops) noexcept
cdef int take(Front front, double length, bint go) except -1
