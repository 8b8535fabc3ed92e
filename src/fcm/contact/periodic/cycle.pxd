from fcm.contact.contact_kernel cimport ContactKernel, ContactParameters, ForceDerivatives, FourierIntegrals
from fcm.contact.periodic.motion cimport ZeroCrossings, CycleEvents

cdef int STICK, POSITIVE, NEGATIVE, SEPARATION
cdef int STICKS, SIGNED_SLIPS, CONTACT, LONG

cpdef int join_states(int[::1] state, int[::1] piece, int count) noexcept nogil

cdef class LineCycle(CycleEvents):
    cdef readonly ZeroCrossings crossings
    cdef readonly int pieces
    cdef readonly int[::1] state, event, cause
    cdef readonly double[::1] begin, rest
    cdef int slipping, span, span_cause
    cdef double span_begin, w
    cdef void add(self, int state, int event, double theta, double rest, int cause) noexcept nogil
    cdef double length(self, int p) noexcept nogil
    cdef double along(self, int p) noexcept nogil
    cdef void close(self) noexcept nogil
    cdef bint pushes(self, int side) noexcept nogil
    cdef void advance(self, int end, double theta, int kind) noexcept nogil
    cdef void slip(self, int side, int end, double theta) noexcept nogil
    cdef double slip_begin(self, int side, int end, double theta) noexcept nogil

    cdef readonly double overlap, greatest_lower, least_upper, start
    cdef readonly int behaviour, kind
    cdef double[::1] numbers
    cdef ContactParameters contact
    cdef int take(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef bint known(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef int solve(self, int behaviour, double start) noexcept nogil
    cdef bint far_inside(self, double start) noexcept nogil
    cdef void sort_cuts(self) noexcept nogil
    cdef int never_open(self, double start) noexcept nogil
    cdef void march(self, int first, int kind) noexcept nogil

cdef class LineIntegrals(FourierIntegrals):
    cdef readonly LineCycle cycle
    cdef double[::1] total_re, total_im, stick_re, stick_im, grow_re, grow_im, points, weights
    cdef void integrate(self) noexcept nogil
    cdef void piece(self, int p, int begin, int end, double length) noexcept nogil
    cdef void short_stick(self, int p, int begin, double length) noexcept nogil
    cdef void grow(self, double re, double im) noexcept nogil

cdef class LineDerivatives(ForceDerivatives):
    cdef readonly LineCycle cycle
    cdef double[::1] memory
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
    cdef void gradient(self, int p) noexcept nogil
    cdef void remember(self, int p) noexcept nogil

cdef class PeriodicContact(ContactKernel):
    cdef readonly LineCycle cycle
    cdef readonly LineIntegrals integrals
    cdef readonly LineDerivatives derivatives
    cdef int solve(self, double[::1] x, Py_ssize_t first, ContactParameters contact) noexcept nogil
    cdef void resist(self, ContactParameters contact, double[:, ::1] resistance) noexcept nogil
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
