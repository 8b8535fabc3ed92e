from fcm.continuation.stepper cimport Stepper

cdef class Landing:
    cdef readonly bint met
    cdef double[:, ::1] value
    cdef double up_to(self, Stepper stepper, double step) except -1
    cdef double across(self, Stepper stepper, double step) except -1
