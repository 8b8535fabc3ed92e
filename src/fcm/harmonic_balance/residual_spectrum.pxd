from fcm.structure.receptance cimport ForcedModes, Receptance

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

cdef class EnrichedMotion:
    cdef public Receptance receptance
    cdef public list laws
    cdef readonly int contacts, width, wide, directions
    cdef bint few
    cdef readonly double[::1] x
    cdef readonly double shift
    cdef int[::1] place
    cdef double[:, ::1] force, matrix
    cdef double[:, :, ::1] resistance
    cdef object stiffness
    cdef double[::1] right
    cdef int[::1] swapped
    cpdef int at(self, double[::1] z) except -1
    cdef void unknowns(self, double[::1] z) noexcept
    cdef void displace(self, Py_ssize_t h) noexcept
    cdef int displace_many(self, int h) except -1
    cdef double relative_addition(self, Py_ssize_t first, Py_ssize_t ports, double least) noexcept
