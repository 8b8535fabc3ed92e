from fcm.continuation.point cimport Point

cdef class PointStore:
    cdef readonly int count
    cdef readonly int size
    cdef double[:, ::1] z
    cdef double[:, ::1] direction
    cdef double[::1] orientation
    cdef long[::1] mark
    cdef int add(self, Point point, double[::1] scale, long mark) except -1
    cpdef int put(self, double[::1] z, double[::1] direction, long mark, double orientation) except -1
    cdef int widen(self) except -1
    cdef bint ends_at(self, Point point) except -1
    cdef bint same(self, Py_ssize_t i, Py_ssize_t k, double part) except -1
    cdef int mark_last(self, long mark) except -1
