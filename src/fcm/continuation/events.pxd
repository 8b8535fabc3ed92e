from fcm.continuation.options cimport EventOptions
from fcm.continuation.point cimport Point
from fcm.continuation.stepper cimport Stepper

cdef double LOST
cdef int MARGIN, FOLD, PEAK, PASSING

cdef class Secants:
    cdef readonly double low, high, width, secant, at
    cdef bint may_jump
    cdef double before, after, last, last_value, now, now_value
    cdef double first_width, first_difference, width_in_turn
    cdef int looks
    cdef void aim(self) noexcept
    cdef bint jumps(self) noexcept
    cpdef bint known(self, double fine, bint after_next=*) except -1
    cpdef int saw(self, double at, double value) except -1

cdef class Landing:
    cdef readonly bint met
    cdef double[:, ::1] value
    cdef double up_to(self, Stepper stepper, double step) except -1
    cdef double across(self, Stepper stepper, double step) except -1

cdef class TestFunction:
    cdef int kind
    cdef Py_ssize_t k
    cdef double value

cdef double value(Stepper stepper, Point point, TestFunction function) except? -1
cdef double root_within(Stepper stepper, TestFunction function) except? -1
cdef double root(
    Stepper stepper, TestFunction function, double low, double high, double before, double after
) except? -1
cdef bint quiet(Stepper stepper, double[::1] values, double[::1] greatest) except -1
cdef bint turns(Point here, Point there, Py_ssize_t k, double greatest, EventOptions options) except -1
cdef bint may_exceed(Stepper stepper, Py_ssize_t k, double greatest) except -1
cdef bint closes(Stepper stepper, double[::1] first, double[::1] head) except -1
