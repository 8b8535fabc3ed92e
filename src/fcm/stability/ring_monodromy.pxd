from fcm.stability.monodromy cimport Monodromy

cdef class RingMonodromy(Monodromy):
    cdef double part, start
    cdef object renumber, source
    cdef int first
    cdef int[::1] memory
    cpdef int follow(self, double omega) except -1
    cdef void widest(self) noexcept
    cdef int begin(self) except -1
