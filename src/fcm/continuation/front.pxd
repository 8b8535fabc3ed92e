from fcm.continuation.newton cimport Newton
from fcm.continuation.place cimport Place
from fcm.continuation.prediction cimport Prediction
from fcm.continuation.problem cimport Problem

cdef class Front:
    cdef public Problem problem
    cdef public Newton newton
    cdef public Place here
    cdef public Place there
    cdef public Place between
    cdef public double step
    cdef public double missed
    cdef public double turn
    cdef public int which
    cdef public Prediction prediction
    cdef double past
    cdef double[::1] guess
    cpdef int begin(self, double[::1] z, double[::1] row) except -1
    cpdef bint go(self, double step) except -1
    cpdef bint put(self, double at, bint margins, bint outputs) except -1
    cpdef bint near(self, double at, double[::1] guess) except -1
    cpdef bint land(self, double parameter) except -1
    cpdef int accept(self, Place place, double length) except -1
    cpdef bint sharpen(self, bint margins, bint outputs) except -1
    cpdef bint shorten(self, double at) except -1
    cpdef int drift(self, double step) except -1
    cpdef double length(self, Place place) except -1e300
    cdef bint exactly(self) except -1
    cdef bint sought(self, double step) except -1
    cdef int record(self, Place place, bint margins, bint outputs) except -1
    cdef double spread(self) noexcept
    cdef void interpolate(self, double at) noexcept
