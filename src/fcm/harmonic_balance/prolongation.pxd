from fcm.continuation.corrector cimport Newton
from fcm.continuation.problem cimport Problem
from fcm.harmonic_balance.residual cimport Balance

cdef class ForceLevelProblem(Problem):
    cdef public Balance balance
    cdef public double omega
    cdef bint many
    cdef double min_level_unit
    cdef double[::1] z
    cdef void place(self, double[::1] z) noexcept

cdef class Homotopy(Problem):
    cdef public Problem inner
    cdef public double subtracted_part
    cdef public double[::1] initial_residual

cdef class Prolongation:
    cdef public Balance balance
    cdef public Homotopy homotopy
    cdef public Newton newton
    cdef public double tolerance
    cdef list more, fewer
    cdef bint many
    cdef bint costly_size
    cdef bint brief
    cdef bint damps
    cdef int max_iterations, max_chord_steps, max_damped_steps
    cdef double final_step, max_change, min_cosine, chord_step, chord_contraction, max_first_step
    cdef double min_damping, min_factor, max_factor, damped_final_step
    cdef tuple homotopy_parts
    cdef public double[::1] found
    cdef int[::1] place
    cdef double[::1] guess
    cdef double[::1] row
    cdef double[::1] still
    cdef double[::1] prediction
    cdef double[::1] begin
    cdef double[::1] way
    cdef unsigned char[::1] normal
    cpdef int predict_from(self, double[::1] z, double[::1] there) except -1
    cpdef bint find_normal(self, double[::1] z, double[::1] direction, bint briefly=*) except -1
    cpdef bint find_at_frequency(self, double[::1] z, bint gradually) except -1
    cpdef bint rebalance(self, double[::1] z, double[::1] lack) except -1
    cdef int hold(self, double[::1] z) except -1
    cdef bint report(self) except -1
    cdef bint correct(self) except -1
    cdef bint correct_at_once(self, double[::1] guess, double taken=*) except -1
    cdef bint correct_by_homotopy(self, double[::1] guess) except -1
    cdef bint keeps_direction(self) except -1
    cdef bint newton_to_tolerance(self) except -1
    cdef bint damped_newton(self) except -1
    cdef bint chord_steps_converge(self, double tolerance, double before) except -1
    cdef void move(self) noexcept
    cdef double strain_from(self, double[::1] guess) except -1
    cdef double strain(self, double[::1] x) except -1
    cdef double spring(self, Py_ssize_t i) except -1
    cdef double distance_from(self, double[::1] guess) except -1
