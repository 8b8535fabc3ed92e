from fcm.stability.planar_monodromy cimport VariationalSteps

cdef class ManyPlanarMonodromy(VariationalSteps):
    cdef object poll, options, shapes, natural, damping, all_soft, moving, number, remembered, open
    cdef object k_u, springs, ratios, K_closed, seen_closed, soft_closed, seen, soft, push, g_before
    cdef double omega, coefficient_floor
    cdef readonly int modes, columns
    cdef int slipping, room
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
