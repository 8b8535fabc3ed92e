cdef class Segments:
    cdef public Py_ssize_t count
    cdef readonly double[:, ::1] y, slack
    cdef readonly signed char[:, ::1] states
    cdef readonly double[::1] start, length
    cdef readonly Py_ssize_t[::1] ended
