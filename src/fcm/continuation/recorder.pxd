from fcm.continuation.stepper cimport Stepper
from fcm.continuation.point cimport Point
from fcm.continuation.point cimport PointStore

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
    cdef bint revisits_station(self) except -1
    cdef bint revisits_corner(self) except -1
    cdef int add(self, long mark) except -1
    cdef int add_corner(self, Point point) except -1
    cdef void update_greatest(self) noexcept
    cdef bint closed(self) except -1
    cdef bint inside(self) noexcept
