cdef int FREE

cdef class StateSequence:
    cdef readonly int contacts
    cdef public int events
    cdef readonly double[::1] angle, along
    cdef readonly int[::1] whose, into, order, state, remembers
    cdef void occurs(self, double angle, int c, int into, double along) noexcept
    cdef void sort(self) noexcept
    cdef void begin(self) noexcept
