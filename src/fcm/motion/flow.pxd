cdef class Flows:
    cdef readonly Py_ssize_t modes, contacts, linear, size, count, capacity
    cdef readonly double omega
    cdef readonly double[::1] stiffness, damping, mu, k_u, k_v, n_0
    cdef readonly double[:, ::1] drive, tangential, normal, push_u, push_v
    cdef readonly signed char[::1] rough
    cdef readonly signed char[:, ::1] states
    cdef readonly double[::1] step
    cdef readonly Py_ssize_t[::1] exits
    cdef readonly Py_ssize_t[:, ::1] owner
    cdef readonly signed char[:, ::1] goal
    cdef readonly double[:, :, ::1] row, table, table_forced, sizes, sizes_forced
    cdef readonly double[:, :, :, ::1] power, forced, rounding, rounding_forced
    cdef readonly double[:, :, ::1] turn
    cdef double[::1] made_for, _whole
    cdef dict _pool
    cdef double[:, ::1] _terms, _rates, _grades, _exits
    cdef Py_ssize_t find(self, signed char[:, ::1] states, Py_ssize_t k) noexcept nogil
    cdef void refresh(self, Py_ssize_t slot) noexcept nogil
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b, double factor) noexcept nogil
    cdef void taylor(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] terms) noexcept nogil
    cdef void advance(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void part(self, Py_ssize_t slot, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] terms, int known, int last) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, double[:, ::1] terms, int first, int last, double[:, ::1] exits) noexcept nogil
    cdef void bound(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] out) noexcept nogil
    cdef void _unit(self, Py_ssize_t slot, Py_ssize_t b) noexcept nogil
    cdef void _double(self, Py_ssize_t slot) noexcept nogil
    cdef void _look(self, Py_ssize_t slot) noexcept nogil
    cdef void watch(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] seen) noexcept nogil
cdef void summed(double[:, ::1] terms, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil
