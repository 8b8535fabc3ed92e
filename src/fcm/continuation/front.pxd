from fcm.continuation.newton cimport Newton
from fcm.continuation.problem cimport Problem

cdef class Place:
    cdef public double[::1] z
    cdef public double[::1] tangent
    cdef public double[::1] margin
    cdef public int[::1] kind
    cdef public double[::1] angle
    cdef public double[::1] slope
    cdef public double[::1] output
    cdef public double[::1] growth
    cdef public double orientation
    cdef public double shift

cdef class Front:
    cdef public Problem problem
    cdef public Newton newton
    cdef public Place here
    cdef public Place there
    cdef public Place between
    cdef public double step
    cdef public double missed
    cdef public double turn
    cdef double past
    cdef public int which
    cdef public double[::1] bend
    cdef double[::1] guess
    cpdef int begin(self, double[::1] z, double[::1] row) except -1
    cpdef bint go(self, double step) except -1
    cpdef bint put(self, double at, bint margins, bint outputs) except -1
    cpdef bint land(self, double parameter) except -1
    cpdef int accept(self, Place place, double length) except -1
    cpdef double ahead(self, double step) except -1
    cpdef bint cross(self, Py_ssize_t which, double past) except -1
    cpdef bint cross_softly(self, double past) except -1
    cpdef bint crosses(self) except -1
    cpdef double dip(self) except -1
    cdef int incline(self, Place place) except -1
    cpdef Py_ssize_t partner(self, Py_ssize_t k, int[::1] kind, double[::1] angle) except -2
    cpdef double margin(self, Py_ssize_t k, Place place) except -1e300
    cpdef bint sharpen(self, bint margins, bint outputs) except -1
    cpdef bint shorten(self, double at) except -1
    cpdef double length(self, Place place) except -1e300
    cpdef double extent(self) except -1
    cpdef double unforeseen(self) except -1
    cdef double softly(self, double step) except -1
    cdef int bear(self, double sign) except -1
    cdef bint crossed(self, double step) except -1
    cdef double value(self, Py_ssize_t k) noexcept
    cdef double beyond(self, Py_ssize_t which, double past) except -1e300
    cdef int adopt(self, Py_ssize_t which, double before) except -1
    cdef bint sought(self, double step) except -1
    cdef int record(self, Place place, bint margins, bint outputs) except -1
    cdef void predict(self, double step) noexcept
    cdef void interpolate(self, double at) noexcept

cdef double greater(double a, double b) noexcept nogil
cdef Py_ssize_t nearest(int wanted, double at, int[::1] kind, double[::1] angle) noexcept
cdef Py_ssize_t partner(Place place, Py_ssize_t k, int[::1] kind, double[::1] angle) noexcept
cdef double lowest(double before, double begin, double after, double end) noexcept nogil
