from fcm.contact.contact_kernel cimport ContactParameters
from fcm.contact.plane.cycle cimport PlanarContact

cdef class PlanarSequence:
    cdef readonly int contacts, width, moving, held, capacity, highest
    cdef public bint yielding
    cdef readonly object options
    cdef double invisible
    cdef PlanarContact kernel
    cdef ContactParameters parameters
    cdef readonly double[:, ::1] contact, begin, record
    cdef readonly int[::1] count, first
    cdef readonly int[:, ::1] state
    cdef int[::1] piece
    cdef double[:, :, ::1] re, im
    cdef double[::1] mean, order
    cdef double[::1] bary, node
    cdef readonly double e_x, e_y, x_1, y_1, r, r_1
    cpdef bint find_events(self, double[::1] x) except -1
    cdef bint look(self, double[::1] x, int c) except -1
    cdef bint keep(self, int c) except -1
    cpdef int state_at(self, int c, double theta) except -1
    cpdef int remembers(self, int c, double theta) except -1
    cdef void rates(self, int c, double theta) noexcept nogil
    cdef int panel(self, int c, double theta, bint before) noexcept nogil
    cdef void direction(self, int p, double theta) noexcept nogil

cdef class PlanarMonodromy:
    cdef public PlanarSequence sequence
    cdef readonly int contacts, stages, events, steps
    cdef readonly int[::1] state, fresh, held
    cdef int first
    cdef double tolerance, max_step, min_step, min_factor, max_factor, safety, end_factor, max_retry_factor
    cdef double event_tolerance, min_gap, part
    cdef object filled
    cdef int[::1] order, whose, which, stage_counts
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
    cdef object poll, shapes, natural, damping, all_soft, moving, number, remembered, open
    cdef object k_u, springs, ratios, K_closed, seen_closed, soft_closed, seen, soft, push, g_before
    cdef double omega, coefficient_floor
    cdef readonly int modes, columns
    cdef int slipping, room, max_disturbances
    cdef bint arranged
    cdef double[::1] node, C, ratio, stiff
    cdef double[:, ::1] slopes, inner, butcher, tail, K, q, p, q_new, p_new
    cdef double[:, ::1] held_push, e_x, e_y, pressed, kept, whole
    cdef double[:, :, ::1] memory, g, seen_by, pushes, relaxing, by, force
    cdef double[:, :, :, ::1] of_slips, sees
    cdef int[::1] slips, sliders, swapped, swapped_slips
    cdef void slip(self, double theta, double h) noexcept
    cdef bint at_node(self, int i) noexcept
    cdef void push_modes(self, int i) noexcept
    cdef void equations_of_modes(self, double h) noexcept
    cdef void equations_of_slip(self, double h) noexcept
    cdef double move(self, double h) noexcept

cdef class RingPlanarMonodromy(PlanarMonodromy):
    cdef object renumber, source
