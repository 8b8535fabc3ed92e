from fcm.time_domain.flow cimport Flows

cdef double first_descent(double[:, ::1] powers, Py_ssize_t k, double floor, double[:, ::1] work) noexcept nogil

cdef class EventDetector:
    cdef readonly Flows flows
    cdef Py_ssize_t slot, exit
    cdef double base, left, inside
    cdef double[:, ::1] there, powers
    cdef double[::1] slack
    cdef signed char[::1] touched
    cdef int _doubled
    cdef double[:, ::1] _here, _begun, _work
    cdef double[::1] _floors, _largest, _seen
    cdef signed char[::1] _marked
    cdef void begin(self, double[:, ::1] y, double left) noexcept nogil
    cdef bint block(self) except -1 nogil
    cdef bint _suspect(self, Py_ssize_t k, Py_ssize_t e) noexcept nogil
    cdef double _floor(self, Py_ssize_t e) noexcept nogil
    cdef int _stand(self, int steps) except -1 nogil
    cdef bint _passed(self, double before) noexcept nogil
