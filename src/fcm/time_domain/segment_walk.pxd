from fcm.time_domain.flow cimport Flows
from fcm.time_domain.segments cimport Segments

cdef class Walk:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t at, span
    cdef double[:, ::1] ahead
    cdef int _go(self) except -2 nogil
    cdef int visit(self, Py_ssize_t slot) except -1 nogil

cdef class Steps:
    cdef readonly Flows flows
    cdef readonly Segments segments
    cdef readonly Py_ssize_t at, slot
    cdef readonly double left, length, time, h
    cdef readonly double[:, ::1] y, terms
    cdef int next(self) except -2 nogil
