from fcm.continuation.stepper cimport Stepper
from fcm.continuation.point cimport Point
from fcm.continuation.point cimport PointStore

cdef class Recorder:
    cdef readonly Stepper stepper
    cdef readonly PointStore store
    cdef readonly Py_ssize_t n
    cdef readonly double low, high, same
    cdef readonly bint interior, around, stopped
    cdef long last
    cdef int ended_by
    cdef readonly list values
    cdef readonly object greatest
    cdef double[::1] stops, most
    cdef double[::1] first, head
    cdef bint keep(self, double limit) except -1
    cdef bint been(self) except -1
    cdef int add(self, long mark) except -1
    cdef int note(self, Point point) except -1
    cdef void rise(self) noexcept
    cdef bint closed(self) except -1
    cdef bint inside(self) noexcept
