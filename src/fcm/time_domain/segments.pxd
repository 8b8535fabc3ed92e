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

cdef class Segments:
    cdef public Py_ssize_t count
    cdef double[:, ::1] _numbers
    cdef readonly double[:, :] y, slack
    cdef readonly signed char[:, ::1] states
    cdef readonly double[:] start, length, ended
    cdef void _part(self, Py_ssize_t size)
