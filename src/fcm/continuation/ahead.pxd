from fcm.continuation.front cimport Front

cpdef double ahead(Front front, double step) except -1
cdef double softly(Front front, double step) except -1
cdef bint crossed(Front front, double step) except -1
