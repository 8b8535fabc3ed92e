from fcm.harmonic.further cimport Further

cdef class Ranking:
    cdef readonly Further further
    cdef readonly int count
    cdef readonly bint cheap
    cdef readonly list sets
    cdef tuple own
    cdef unsigned char[:, ::1] covers
    cdef double[::1] top
    cdef Py_ssize_t[::1] place
    cdef Py_ssize_t among
    cdef Py_ssize_t choose(self, bint best) except -2
    cdef Py_ssize_t covering(self) except -2
    cdef void rank(self) noexcept
