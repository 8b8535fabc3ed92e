from fcm.continuation.newton cimport Newton
from fcm.harmonic.balance cimport Balance
from fcm.harmonic.homotopy cimport Homotopy

cdef class Lifted:
    cdef public Balance balance
    cdef public Homotopy homotopy
    cdef public Newton newton
    cdef public double enough
    cdef list more, fewer
    cdef bint dear
    cdef bint many
    cdef bint brief
    cdef public double[::1] found
    cdef int[::1] place
    cdef double[::1] guess
    cdef double[::1] row
    cdef double[::1] still
    cpdef bint beside(self, double[::1] z, double[::1] direction, bint briefly=*) except -1
    cdef bint corrected(self) except -1
    cdef bint onward(self) except -1
    cdef bint nearly(self) except -1
    cdef bint again(self, double first) except -1
    cdef double away(self) except -1
