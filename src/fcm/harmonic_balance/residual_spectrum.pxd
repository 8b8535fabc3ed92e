from fcm.structure.receptance cimport ForcedModes

cdef class FurtherHarmonics:
    cdef readonly object system
    cdef readonly int highest, contacts, width, directions
    cdef readonly double[::1] share
    cdef list laws
    cdef ForcedModes modes
    cdef Py_ssize_t[::1] others
    cdef double[::1] natural
    cdef double least, leading
    cdef double[:, :, ::1] force
    cdef double[::1] size
    cpdef int shares_at(self, double[::1] z, double[::1] amplitude) except -1
    cdef int shares_of_many(self, double omega) except -1
    cdef bint is_leading(self, double[::1] z, double[::1] amplitude, Py_ssize_t h) except -1
