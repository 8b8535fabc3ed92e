from fcm.contact.contact_kernel cimport ContactKernel, ForceDerivatives, FourierIntegrals
from fcm.contact.periodic.cycle cimport LineCycle

cdef int STICKS, SIGNED_SLIPS, CONTACT, LONG

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
    cdef void stick(self) noexcept nogil
    cdef void slip(self) noexcept nogil
