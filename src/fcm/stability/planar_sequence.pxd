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
