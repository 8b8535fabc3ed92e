from fcm.continuation.options cimport StepOptions
from fcm.continuation.stepper cimport Stepper

cdef bint changes_sign(Stepper stepper) except -1
cdef bint parameter_is_even(Stepper stepper) except -1
cdef double hidden_sign_change(Stepper stepper) except -1
cdef double hidden_reversal(Stepper stepper, double[::1] greatest) except -1
cdef double parameter_reversal(Stepper stepper) except -1
cdef double cubic_reversal(double rise, double begin, double end, double least, double doubtful) noexcept nogil
cdef double cubic_beyond_zero(double before, double begin, double after, double end) noexcept nogil
cpdef double next_corner(Stepper stepper, double step) except -1
cdef double next_extrapolated_root(Stepper stepper) except -1
cdef double next_label_change(Stepper stepper, double step) except -1
cdef bint prediction_changes_sign(Stepper stepper, double step) except -1

cpdef bint acceptable(Stepper stepper) except -1
cdef bint keeps_orientation(Stepper stepper) except -1
cdef bint within_turn(Stepper stepper) except -1
cpdef bint smooth_step(Stepper stepper, double step) except -1
cpdef double next_step(Stepper stepper) except -1
cpdef double output_error(Stepper stepper) except -1
cpdef double solution_size(Stepper stepper) except -1
