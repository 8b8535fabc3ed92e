from fcm.stability.planar_sequence cimport PlanarSequence

cdef class VariationalSteps:
    cdef public PlanarSequence sequence
    cdef readonly int contacts, stages, events, steps
    cdef readonly int[::1] state, fresh, held
    cdef int first
    cdef double tolerance, max_step, min_step, min_factor, max_factor, safety, end_factor, max_retry_factor
    cdef double event_tolerance, min_gap, next
    cdef object filled
    cdef int[::1] order, whose, which
    cdef double[::1] angle
    cpdef bint begin(self, double omega) except -1
    cpdef double step(self, double theta, double h) except -1
    cpdef int accept(self) except -1
    cpdef int apply_event(self, int c, int i) except -1
    cpdef object disturbances(self)
    cpdef int follow(self, double omega) except -1
    cdef int find(self) except -1
    cdef double start(self) except -1
    cdef bint propagate(self, double theta, double length, bint opens) except -1
