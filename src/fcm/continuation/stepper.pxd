from fcm.continuation.corrector cimport Newton
from fcm.continuation.options cimport FollowOptions
from fcm.continuation.point cimport Point
from fcm.continuation.predictor cimport Predictor
from fcm.continuation.problem cimport Problem

cdef class Stepper:
    cdef public Problem problem
    cdef public FollowOptions options
    cdef public Newton newton
    cdef public Predictor predictor
    cdef public Point here
    cdef public Point there
    cdef public Point between
    cdef public double step
    cdef public double cosine
    cdef public double missed, strayed
    cdef public int which
    cdef public double[::1] aside
    cdef double[::1] guess
    cdef double past
    cdef double close
    cdef double misled
    cpdef int begin(self, double[::1] z, double[::1] row) except -1
    cpdef bint go(self, double step) except -1
    cpdef int accept(self, Point point, double length) except -1
    cpdef int drift(self, double step) except -1
    cdef int incline(self) except -1
    cdef bint exactly(self) except -1
    cdef bint found(self, double step) except -1
    cdef bint roughly(self, double step, double close) except -1
    cpdef bint put(self, double at, bint margins, bint outputs) except -1
    cpdef bint near(self, double at, double[::1] guess) except -1
    cpdef bint land(self, double parameter) except -1
    cpdef bint sharpen(self, bint margins, bint outputs) except -1
    cpdef bint shorten(self, double at) except -1
    cpdef double length(self, Point point) except -1e300
    cdef int record(self, Point point, bint margins, bint outputs) except -1
    cdef double spread(self) noexcept
    cdef void interpolate(self, double at) noexcept
