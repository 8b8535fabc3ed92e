from fcm.structure.receptance cimport Receptance

cdef class EnrichedMotion:
    cdef public Receptance seen
    cdef public list laws
    cdef readonly int contacts, width, wide, directions
    cdef readonly double[::1] x
    cdef readonly double shift
    cdef int[::1] place
    cdef double[:, ::1] force, matrix
    cdef double[:, :, ::1] resistance
    cdef double[::1] right
    cdef int[::1] swapped
    cpdef int at(self, double[::1] z) except -1
    cdef void unknowns(self, double[::1] z) noexcept
    cdef void displace(self, Py_ssize_t h) noexcept
    cdef int displace_many(self, int h) except -1
    cdef double relative_addition(self, Py_ssize_t first, Py_ssize_t ports, double least) noexcept
