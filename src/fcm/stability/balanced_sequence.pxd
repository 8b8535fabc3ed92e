from fcm.contact.periodic.cycle cimport Cycle
from fcm.contact.periodic.motion cimport Motion
from fcm.stability.state_sequence cimport StateSequence

cdef class BalancedSequence(StateSequence):
    cdef readonly Motion motion
    cdef readonly Cycle cycle
    cdef readonly int width, moving, held
    cdef public bint yielding
    cdef readonly double[:, ::1] contact
    cpdef bint find_events(self, double[::1] x) except -1
    cdef bint contact_cycle(self, double[::1] x, int c) noexcept
    cdef bint opens(self) noexcept
    cdef double limit_at(self, int p) noexcept
