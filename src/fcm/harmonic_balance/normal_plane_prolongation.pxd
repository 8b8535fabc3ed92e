from fcm.continuation.corrector cimport Newton
from fcm.harmonic_balance.residual cimport Balance
from fcm.harmonic_balance.homotopy cimport Homotopy

cdef class Lifted:
    cdef public Balance balance
    cdef public Homotopy homotopy
    cdef public Newton newton
    cdef public double enough
    cdef list more, fewer
    cdef bint many
    cdef bint dear
    cdef bint brief
    cdef bint damps
    cdef int steps
    cdef double least
    cdef double shorter
    cdef double longer
    cdef double last
    cdef public double[::1] found
    cdef int[::1] place
    cdef double[::1] guess
    cdef double[::1] row
    cdef double[::1] still
    cdef double[::1] ahead
    cdef double[::1] begin
    cdef double[::1] way
    cdef unsigned char[::1] normal
    cpdef int lead(self, double[::1] z, double[::1] there) except -1
    cpdef bint beside(self, double[::1] z, double[::1] direction, bint briefly=*) except -1
    cpdef bint normal_point(self, double[::1] z, bint gradually) except -1
    cpdef bint rebalance(self, double[::1] z, double[::1] lack) except -1
    cdef int hold(self, double[::1] z) except -1
    cdef bint report(self) except -1
    cdef bint corrected(self) except -1
    cdef bint at_once(self, double[::1] guess, double taken=*) except -1
    cdef bint by_parts(self, double[::1] guess) except -1
    cdef bint onward(self) except -1
    cdef bint nearly(self) except -1
    cdef bint damped(self) except -1
    cdef bint again(self, double enough, double before) except -1
    cdef void move(self) noexcept
    cdef double strained(self, double[::1] guess) except -1
    cdef double strain(self, double[::1] x) except -1
    cdef double spring(self, Py_ssize_t i) except -1
    cdef double away(self, double[::1] guess) except -1
