from fcm.continuation.place cimport Place
from fcm.continuation.step cimport Step

cdef double LOST
cdef int MARGIN, FOLD, PEAK, PASSING

cdef class Sought:
    cdef int kind
    cdef Py_ssize_t k
    cdef double value

cdef double value(Step step, Place place, Sought sought) except? -1
cdef double root_within(Step step, Sought sought) except? -1
cdef double root(Step step, Sought sought, double low, double high, double before, double after) except? -1
