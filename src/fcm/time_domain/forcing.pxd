cdef class Pool:
    cdef readonly Py_ssize_t modes, contacts, springs, linear, size, waves, count, clock
    cdef readonly double omega, highest
    cdef readonly double[::1] harmonic, stiffness, damping, mu, k_u, k_v, n_0
    cdef readonly double[::1] hold
    cdef readonly double[:, ::1] constant, square, drive, slope, tangential, normal, push_u, push_v, stretch, pull
    cdef readonly signed char[::1] rough, halved
    cdef readonly signed char[:, ::1] states
    cdef readonly double[::1] step
    cdef readonly Py_ssize_t[::1] exits, reached, watched, squared, spelled
    cdef readonly Py_ssize_t[:, ::1] owner, first, spread
    cdef readonly signed char[:, ::1] goal
    cdef readonly double[:, :, ::1] terms, row, table, table_forced, series, series_forced, sizes, sizes_forced
    cdef readonly double[:, :, :, ::1] power, forced, push, pushed, kick
    cdef readonly double[:, :, ::1] rotation
    cdef readonly double[::1] made_for
    cdef dict _pool
    cdef Py_ssize_t min_count
    cdef double max_bytes
    cdef readonly Py_ssize_t[::1] used
    cdef Py_ssize_t find(self, signed char[:, ::1] states, Py_ssize_t k) noexcept nogil

cdef class Series(Pool):
    cdef double[:, ::1] _own
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] z, Py_ssize_t last, double step, double[:, ::1] y, bint graded) noexcept nogil

cdef class Forced(Series):
    cdef double[::1] whole
    cdef int refresh(self, Py_ssize_t slot) except -1 nogil
    cdef int reach(self, Py_ssize_t slot, Py_ssize_t last) except -1 nogil
    cdef void _one_step(self, Py_ssize_t slot) noexcept nogil
    cdef void _sum_terms(self, Py_ssize_t slot, Py_ssize_t h) noexcept nogil
    cdef void _add_term(self, Py_ssize_t slot, Py_ssize_t h, int j, double power, double slope) noexcept nogil
    cdef void _sized(self, Py_ssize_t slot) noexcept nogil
    cdef void _double(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void free(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) noexcept nogil
