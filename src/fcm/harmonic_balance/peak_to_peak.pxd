cdef int MANY

cdef class Extremes:
    cdef public double[::1] harmonics
    cdef public int count
    cdef public int dofs
    cdef public int samples
    cdef public double[:, ::1] parts
    cdef public double[:, ::1] re
    cdef public double[:, ::1] im
    cdef public double[:, ::1] d_re
    cdef public double[:, ::1] d_im
    cdef public double[::1] amplitude
    cdef public double[::1] growth
    cdef public double[:, ::1] angles
    cdef double[:, ::1] cosine
    cdef double[:, ::1] sine
    cdef object sampling
    cdef double[::1] wave
    cdef double[::1] c
    cdef double[::1] s
    cdef double value
    cdef double rate
    cdef double angle
    cdef int fill(self) except -1
    cdef int many(self) except -1
    cdef void both(self, Py_ssize_t d) noexcept
    cdef void greatest(self, Py_ssize_t d, int side, double between) noexcept
    cdef void single(self, Py_ssize_t d) noexcept
    cdef void several(self, Py_ssize_t d) noexcept
    cdef void extreme(self, Py_ssize_t d, Py_ssize_t k) noexcept
    cdef void waves_at(self, double theta) noexcept
