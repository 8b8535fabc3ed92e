from fcm.contact.periodic.crossings cimport Crossings
from fcm.contact.periodic.events cimport Events

cdef int STICK, POSITIVE, NEGATIVE, SEPARATION

cdef class Slider(Events):
    cdef readonly Crossings crossings
    cdef readonly int pieces
    cdef readonly int[::1] state, event, cause
    cdef readonly double[::1] begin, rest
    cdef int slipping, span, span_cause
    cdef double span_begin, w
    cdef void add(self, int state, int event, double theta, double rest, int cause) noexcept nogil
    cdef void close(self) noexcept nogil
    cdef bint pushes(self, int side) noexcept nogil
    cdef void advance(self, int end, double theta, int kind) noexcept nogil
    cdef void slip(self, int side, int end, double theta) noexcept nogil
    cdef double slip_begin(self, int side, int end, double theta) noexcept nogil
