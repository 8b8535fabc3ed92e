from fcm.continuation.corrector cimport Newton
from fcm.continuation.options cimport FollowOptions, StepOptions
from fcm.continuation.predictor cimport Predictor
from fcm.continuation.problem cimport Point, Problem

cdef class Stepper:
    cdef public Problem problem
    cdef public FollowOptions options
    cdef public Newton newton
    cdef public Predictor predictor
    cdef public Point here
    cdef public Point there
    cdef public Point between
    cdef public double step
    cdef public double cosine
    cdef public double miss, parameter_miss, rounding
    cdef public int next_margin
    cdef public double[::1] offset
    cdef double[::1] guess
    cdef double known_length
    cdef double tolerance
    cdef double max_newton_step
    cpdef int begin(self, double[::1] z, double[::1] row) except -1
    cpdef bint try_step(self, double step) except -1
    cpdef int accept(self, Point point, double length) except -1
    cpdef int move_short(self, double step) except -1
    cdef int differentiate_margins(self) except -1
    cdef bint update_tangent(self) except -1
    cdef bint correct_step(self, double step) except -1
    cdef bint correct_to(self, double step, double tolerance) except -1
    cpdef bint find_between(self, double at, bint margins, bint outputs) except -1
    cpdef bint find_from_guess(self, double at, double[::1] guess) except -1
    cpdef bint find_at_parameter(self, double parameter) except -1
    cpdef bint sharpen(self, bint margins, bint outputs) except -1
    cpdef bint shorten(self, double at) except -1
    cpdef double length(self, Point point) except -1e300
    cdef int record(self, Point point, bint margins, bint outputs) except -1
    cdef double clipped_cosine(self) noexcept
    cdef void interpolate(self, double at) noexcept

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
cdef bint passes_branch_point(Stepper stepper) except -1
cdef bint within_turn(Stepper stepper) except -1
cpdef bint smooth_step(Stepper stepper, double step) except -1
cpdef double next_step(Stepper stepper) except -1
cpdef double output_error(Stepper stepper) except -1
cpdef double solution_size(Stepper stepper) except -1
