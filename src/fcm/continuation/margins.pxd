from fcm.continuation.front cimport Front

cdef bint crosses(Front front) except -1
cdef double dip(Front front) except -1
cdef double lowest(double before, double begin, double after, double end) noexcept nogil
