from fcm.contact.closed_form cimport CoefficientLaw
from fcm.contact.contact_kernel cimport ContactKernel, ContactParameters, CycleMeasures
from fcm.contact.periodic.margins cimport RegimeMargins

cdef int KINDS

cdef class Law(ContactParameters):
    cdef public int width
    cdef public int directions
    cdef public int margins
    cdef public bint nonlinear
    cdef public double[::1] force
    cdef public double[:, ::1] tangent
    cdef public double[:, ::1] resistance
    cdef public double[::1] margin
    cdef public int[::1] kind
    cdef public double[::1] angle
    cdef public int pieces
    cdef public int[::1] state
    cdef public double[::1] contact_loads
    cpdef int evaluate(self, double[::1] x, Py_ssize_t first) except -1
    cpdef int evaluate_forces(self, double[::1] x, Py_ssize_t first) except -1
    cpdef int evaluate_margins(self, double[::1] x, Py_ssize_t first) except -1
    cpdef double squared_margin(self, int kind, double[::1] x, Py_ssize_t first) except? -1.0
    cpdef int compute_resistance(self) except -1
    cpdef int cycle(self, double[::1] x, Py_ssize_t first) except -1

cdef class KernelLaw(Law):
    cdef public ContactKernel kernel
    cdef public RegimeMargins bounds
    cdef public CycleMeasures measures
    cdef int forces(self, double[::1] x, Py_ssize_t first, bint tangent) except -1

cdef class SingleHarmonicLaw(Law):
    cdef public CoefficientLaw coefficients
    cdef double[::1] numbers
    cdef double[:, ::1] slopes
    cdef double least, most
    cpdef bint rests(self) except -1
    cdef double limit(self, double[::1] x, Py_ssize_t first, double sign) noexcept
    cdef void limits(self, double[::1] x, Py_ssize_t first, double b) noexcept
    cdef void slipping(self, double[::1] x, Py_ssize_t first, double b) noexcept
    cdef void chain(self, double[::1] x, Py_ssize_t first, double n0_bar, double b_bar, double a, double b) noexcept
    cdef void stuck(self, double[::1] x, Py_ssize_t first) noexcept
    cdef void normal(self, double[::1] x, Py_ssize_t first, double b) noexcept
