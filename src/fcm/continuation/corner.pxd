from fcm.continuation.front cimport Front
from fcm.continuation.place cimport Place

cpdef Py_ssize_t come(Front front, Place place, double at, Py_ssize_t which) except -2
cpdef bint cross(Front front, Py_ssize_t which, double past) except -1
cpdef bint cross_softly(Front front, double past) except -1
cdef void aim(Front front, double past) noexcept
cdef int bear(Front front, double sign) except -1
cdef double beyond(Front front, Py_ssize_t which, double past) except -1e300
cdef int adopt(Front front, Py_ssize_t which, double before) except -1
