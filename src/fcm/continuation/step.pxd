from fcm.continuation.newton cimport Newton
from fcm.continuation.place cimport Place
from fcm.continuation.problem cimport Problem

cdef class Step:
    cdef public Problem problem
    cdef public Newton newton
    cdef public Place here
    cdef public Place there
    cdef public Place between
    cdef public double step
    cdef public double cosine
    cdef double[::1] guess
    cpdef bint put(self, double at, bint margins, bint outputs) except -1
    cpdef bint near(self, double at, double[::1] guess) except -1
    cpdef bint land(self, double parameter) except -1
    cpdef bint sharpen(self, bint margins, bint outputs) except -1
    cpdef bint shorten(self, double at) except -1
    cpdef double length(self, Place place) except -1e300
    cdef int record(self, Place place, bint margins, bint outputs) except -1
    cdef double spread(self) noexcept
    cdef void interpolate(self, double at) noexcept
