from fcm.contact.closed_form cimport CoefficientLaw
from fcm.harmonic_balance.contact_law cimport Law

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
