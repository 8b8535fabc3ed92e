from fcm.continuation.problem cimport Point, PointStore
from fcm.continuation.step_control cimport Stepper

cdef class Recorder:
    cdef readonly Stepper stepper
    cdef readonly PointStore store
    cdef readonly Py_ssize_t n
    cdef readonly double low, high, same, far
    cdef readonly bint interior, came_around, stopped
    cdef long last
    cdef int ended_by
    cdef readonly list values
    cdef readonly object greatest
    cdef double[::1] stops, most
    cdef double[::1] first, initial_direction
    cdef bint keep_events(self, double limit) except -1
    cdef bint revisits_user_point(self) except -1
    cdef bint revisits_corner(self) except -1
    cdef bint along(self, Py_ssize_t i, Py_ssize_t k) except -1
    cdef int add(self, long mark) except -1
    cdef int add_corner(self, Point point) except -1
    cdef void update_greatest(self) noexcept
    cdef bint closed(self) except -1
    cdef bint inside(self) noexcept

cdef double before_corner(Stepper stepper) except? -1

cdef class NonsmoothPoints:
    cdef Recorder recorder
    cdef bint labelled
    cdef double[::1] growth_before
    cdef bint pass_corner(self, Point point, double length, double past) except -1
    cdef bint is_peak(self) noexcept

cpdef int go_to_corner(Stepper stepper, Point point, double pass_corner) except -1
cdef int turn_beyond(Stepper stepper, double length) except -1
cpdef bint cross_corner(Stepper stepper, double[::1] stops) except -1
cpdef bint cross_label(Stepper stepper, double past) except -1
cdef void predict_past_label(Stepper stepper, double past) noexcept
cdef bint point_beyond(Stepper stepper, double length) except -1
cdef bint close_to_prediction(Stepper stepper, double length) noexcept
cdef bint without_sign_change(Stepper stepper, double length) except -1
cdef bint predict_beyond(Stepper stepper, double length) except -1
cdef bint passes_user_point(Stepper stepper, double[::1] stops) noexcept
cdef int accept_beyond(Stepper stepper, double length, bint go) except -1
