from fcm.continuation.place cimport Place
from fcm.continuation.prediction cimport Prediction
from fcm.continuation.step cimport Step

cdef double PRELIMINARY

cdef class Front(Step):
    cdef public double missed, strayed
    cdef public int which
    cdef public Prediction prediction
    cdef double past
    cdef public double[::1] aside
    cdef double close
    cpdef int begin(self, double[::1] z, double[::1] row) except -1
    cpdef bint go(self, double step) except -1
    cpdef int accept(self, Place place, double length) except -1
    cpdef int drift(self, double step) except -1
    cdef int incline(self) except -1
    cdef bint exactly(self) except -1
    cdef bint sought(self, double step) except -1
    cdef bint twice(self, double step) except -1
    cdef bint roughly(self, double step, double close) except -1
