from fcm.contact.contact_kernel cimport ContactParameters
from fcm.contact.periodic.cycle cimport LineCycle
from fcm.contact.periodic.motion cimport LineMotion

cdef int FREE

cdef class StateSequence:
    cdef readonly int contacts
    cdef public int events
    cdef readonly double[::1] angle, along
    cdef readonly int[::1] whose, into, order, state, remembers
    cdef void add_event(self, double angle, int c, int into, double along) noexcept
    cdef void sort(self) noexcept
    cdef void begin(self) noexcept

cdef class BalancedSequence(StateSequence):
    cdef readonly LineMotion motion
    cdef readonly LineCycle cycle
    cdef readonly int width, moving, held
    cdef public bint yielding
    cdef readonly double[:, ::1] contact
    cdef ContactParameters parameters
    cpdef bint find_events(self, double[::1] x) except -1
    cdef bint contact_cycle(self, double[::1] x, int c) noexcept
    cdef bint opens(self) noexcept
