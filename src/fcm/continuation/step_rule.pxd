from fcm.continuation.front cimport Front

cpdef bint good(Front front) except -1
cdef bint kept(Front front) except -1
cpdef bint clear(Front front, double step) except -1
cpdef double next_step(Front front, double longest, bint hasty) except -1
cpdef double unforeseen(Front front) except -1
cpdef double extent(Front front) except -1
