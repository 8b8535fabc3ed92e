from fcm.continuation.options cimport EventOptions
from fcm.continuation.problem cimport Point
from fcm.continuation.step_control cimport Stepper

cdef double NOT_FOUND
cdef int MARGIN, FOLD, PEAK, USER_POINT

cdef class SignChange:
    cdef readonly double low, high, width, secant, at
    cdef bint may_jump
    cdef double before, after, last, last_value, now, now_value
    cdef double first_width, first_difference, width_in_turn, jump_width, jump_difference
    cdef int halving_interval
    cdef int evaluations
    cdef void choose_next(self) noexcept
    cdef bint seems_discontinuous(self) noexcept
    cpdef bint converged(self, double fine, bint after_next=*) except -1
    cpdef int update(self, double at, double value) except -1

cdef class Landing:
    cdef readonly bint shortened
    cdef double[:, ::1] value
    cdef double limit_step(self, Stepper stepper, double step) except -1
    cdef double first_crossed(self, Stepper stepper, double step) except -1

cdef class TestFunction:
    cdef int kind
    cdef Py_ssize_t k
    cdef double value

cdef double value(Stepper stepper, Point point, TestFunction function) except? -1
cdef double root_within(Stepper stepper, TestFunction function) except? -1
cdef double root(
    Stepper stepper, TestFunction function, double low, double high, double before, double after
) except? -1
cdef bint without_events(Stepper stepper, double[::1] values, double[::1] greatest) except -1
cdef bint has_peak(Point here, Point there, Py_ssize_t k, double greatest, EventOptions options) except -1
cdef bint may_exceed(Stepper stepper, Py_ssize_t k, double greatest) except -1
cdef bint closes_curve(Stepper stepper, double[::1] first, double[::1] head) except -1
