from fcm.continuation.options cimport StepOptions
from fcm.continuation.stepper cimport Stepper

cpdef bint good(Stepper stepper) except -1
cdef bint kept(Stepper stepper) except -1
cpdef bint clear(Stepper stepper, double step) except -1
cpdef double next_step(Stepper stepper) except -1
cpdef double unforeseen(Stepper stepper) except -1
cpdef double extent(Stepper stepper) except -1
