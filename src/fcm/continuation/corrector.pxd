from fcm.continuation.bordered_system cimport BorderedSystem
from fcm.continuation.options cimport NewtonOptions

cdef class Newton(BorderedSystem):
    cdef public NewtonOptions options
    cdef public double tolerance
    cdef public double rounding_step
    cpdef bint correct(self, double reach, double most=*) except -1
    cdef bint chord_steps(self, double before) except -1
    cpdef bint single_step(self) except -1
    cpdef bint correct_by_half_steps(self, double reach) except -1
    cdef bint converges(self, double reach, double most) except -1
    cpdef bint take_tangent(self) except -1
    cdef bint at_rounding(self, double step, double ratio, int count) except -1
    cdef bint too_far(self, double step, double before, double most, int count) except -1
    cdef bint is_rounding(self, double step, int count) except -1
