from fcm.continuation.front cimport Front

cdef class Narrow:
    cdef readonly bint met
    cdef double[:, ::1] place
    cdef double up_to(self, Front front, double step) except -1
    cdef double across(self, Front front, double step) except -1
