from fcm.continuation.options cimport StepOptions
from fcm.continuation.stepper cimport Stepper

cpdef bint acceptable(Stepper stepper) except -1
cdef bint keeps_orientation(Stepper stepper) except -1
cdef bint within_turn(Stepper stepper) except -1
cpdef bint smooth_step(Stepper stepper, double step) except -1
cpdef double next_step(Stepper stepper) except -1
cpdef double output_error(Stepper stepper) except -1
cpdef double solution_size(Stepper stepper) except -1
