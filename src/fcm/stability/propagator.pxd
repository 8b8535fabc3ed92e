cdef class Parts:
    cdef double[::1] re, im
    cdef object share, driven, back
    cdef readonly Py_ssize_t modes, count
    cpdef int carry(self, double time, double omega, object X) except -1
    cdef void grow(self, double time, double[:, ::1] part, double[:, ::1] drive) noexcept

cdef void turn(double[::1] re, double[::1] im, double[::1] by_re, double[::1] by_im, double times, double times_im) noexcept
