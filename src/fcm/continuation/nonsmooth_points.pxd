from fcm.continuation.point cimport Point
from fcm.continuation.recorder cimport Recorder
from fcm.continuation.stepper cimport Stepper

cdef double before_corner(Stepper stepper) except? -1

cdef class NonsmoothPoints:
    cdef Recorder recorder
    cdef bint labelled
    cdef double[::1] grew
    cdef int at(self, Point point, double length, double past) except -1
    cdef bint peaked(self) noexcept

cpdef int come(Stepper stepper, Point point, double at) except -1
cpdef bint cross(Stepper stepper, double[::1] stops) except -1
cpdef bint cross_label(Stepper stepper, double past) except -1
cdef void aim(Stepper stepper, double past) noexcept
cdef bint leaves(Stepper stepper, double length) except -1
cdef bint near(Stepper stepper, double length) noexcept
cdef bint free(Stepper stepper, double length) except -1
cdef bint onwards(Stepper stepper, double length) except -1
cdef bint passes(Stepper stepper, double[::1] stops) noexcept
cdef int take(Stepper stepper, double length, bint go) except -1
