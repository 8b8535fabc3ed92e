from fcm.contact.law cimport Law as Coefficients
from fcm.harmonic.law cimport Law

cdef class SingleHarmonic(Law):
    cdef public Coefficients coefficients
    cdef public Coefficients exact
    cdef public Coefficients coarse
    cdef double[::1] numbers
    cdef double[:, ::1] slopes
    cdef double limit(self, double[::1] x, Py_ssize_t first, double sign) noexcept
    cdef void slipping(self, double[::1] x, Py_ssize_t first) noexcept
    cdef void chain(self, double[::1] x, Py_ssize_t first, double n0_bar, double b_bar, double a) noexcept
    cdef void stuck(self, double[::1] x, Py_ssize_t first) noexcept
    cdef void normal(self, double[::1] x, Py_ssize_t first) noexcept
