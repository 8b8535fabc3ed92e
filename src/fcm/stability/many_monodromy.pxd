from fcm.stability.state_sequence cimport StateSequence

cdef class ManyMonodromy:
    cdef public StateSequence sequence
    cdef readonly int modes, follows, contacts, columns, first
    cdef double rate, omega
    cdef object slow, fast, natural, ratio, far, stiffness, term, product
    cdef public list remembering
    cdef double[:, ::1] contact, by_slow, by_fast, K, G, L, R, b, bt, out, into
    cdef double[:, ::1] q, v, tq, tv, work, g, w, phi, phi_f, port
    cdef double[::1] damping
    cdef int[::1] state
    cpdef int follow(self, double omega) except -1
    cdef int apply_event(self, int e) except -1
    cdef void seen(self, int c) noexcept
    cdef void displacements(self, int c) noexcept
    cdef void add_slider_force(self, int c, double by) noexcept
    cdef void change(self, int c, int was, int to, double unit) noexcept
    cdef void pull(self) noexcept
    cdef int propagate(self, double length) except -1
    cdef int apply(self, double h) except -1
