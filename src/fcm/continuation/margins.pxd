from fcm.continuation.front cimport Front

cdef double RISE, NEARLY_GREATEST

cdef bint crosses(Front front) except -1
cdef bint even(Front front) except -1
cdef double dip(Front front) except -1
cdef double detour(Front front, double[::1] greatest) except -1
cdef double turning(Front front) except -1
cdef double opposite(double rise, double begin, double end, double least) noexcept nogil
cdef double lowest(double before, double begin, double after, double end) noexcept nogil
