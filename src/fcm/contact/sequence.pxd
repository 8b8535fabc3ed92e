from fcm.contact.cycle cimport Cycle

cdef class Sequence(Cycle):
    cdef int count
    cdef double side_shown, last_slip, state, since
    cdef double[:, ::1] regions
    cdef void of(self, double n0_bar, double b_bar, double phi) noexcept nogil
    cdef void take(self) noexcept nogil
    cdef double _seen(self) noexcept nogil
    cdef void _region(self, int letter, double since, double w) noexcept nogil
