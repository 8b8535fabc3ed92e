from fcm.stability.planar_sequence cimport PlanarSequence

cdef class VariationalSteps:
    cdef public PlanarSequence sequence
    cdef readonly int contacts, stages, events, steps
    cdef readonly int[::1] state, fresh, held
    cdef int first
    cdef double tolerance, max_step, min_step, min_factor, max_factor, safety, end_factor, max_retry_factor
    cdef double event_tolerance, min_gap, part
    cdef object filled
    cdef int[::1] order, whose, which, degrees
    cdef double[::1] angle, longest
    cpdef bint begin(self, double omega) except -1
    cpdef double step(self, double theta, double h) except -1
    cpdef int accept(self) except -1
    cpdef int apply_event(self, int c, int i) except -1
    cpdef object disturbances(self)
    cpdef int follow(self, double omega) except -1
    cdef int find(self) except -1
    cdef double start(self) except -1
    cdef bint propagate(self, double theta, double length, bint opens) except -1
    cdef int cheapest(self, double left) except -1

cdef class PlanarMonodromy(VariationalSteps):
    cdef readonly int modes, columns
    cdef int max_disturbances, actives, unknowns
    cdef bint modal, remote
    cdef double coefficient_floor, period, taken
    cdef double[:, ::1] shapes, soft, butcher, slopes, inner, tail, system, seen
    cdef double[::1] natural, damping, node, scale, fore, aft
    cdef double[:, ::1] q, p, memory, force, work, push, q_new, p_new, after, du, stress, rest_to, rest_by
    cdef double[:, :, ::1] q_to, p_to, q_by, p_by, inverse, feels
    cdef double[:, :, :, ::1] answer
    cdef double[:, ::1] kept, e_x, e_y
    cdef int[::1] active
    cdef void activate(self) noexcept
    cdef void displaced(self, int c) noexcept
    cdef double contact_ratio(self, int c) noexcept
    cdef void prepare(self, double h) noexcept
    cdef void respond(self, int m, double h) noexcept
    cdef void couple(self) noexcept
    cdef void slip(self, int c, double theta, double h) noexcept
    cdef void unforced(self) noexcept
    cdef void assemble(self, int a) noexcept
    cdef bint solve(self, int size) noexcept
    cdef void displace(self) noexcept
    cdef void strain(self, int a) noexcept
    cdef void move(self) noexcept
    cdef double rest(self) noexcept

cdef class RingPlanarMonodromy(PlanarMonodromy):
    cdef object renumber, source
