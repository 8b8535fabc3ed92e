from fcm.stability.planar_sequence cimport PlanarSequence
from fcm.stability.variational_steps cimport VariationalSteps

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
