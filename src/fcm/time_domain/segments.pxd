cdef class Segments:
    cdef public Py_ssize_t count
    cdef double[:, ::1] _numbers
    cdef readonly double[:, :] y, slack
    cdef readonly signed char[:, ::1] states
    cdef readonly double[:] start, length, ended
    cdef void _part(self, Py_ssize_t size)
