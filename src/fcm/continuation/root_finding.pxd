cdef class Secants:
    cdef readonly double low, high, width, secant, at
    cdef bint may_jump
    cdef double before, after, last, last_value, now, now_value
    cdef double first_width, first_difference, width_in_turn
    cdef int looks
    cdef void aim(self) noexcept
    cdef bint jumps(self) noexcept
    cpdef bint known(self, double fine, bint after_next=*) except -1
    cpdef int saw(self, double at, double value) except -1
