cdef int SERIES_ORDER, FLOW_POWERS
cdef int STATE_SEPARATED, STATE_STICKING, STATE_POSITIVE_SLIP, STATE_NEGATIVE_SLIP

cdef class FlowArrays:
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
    cdef double max_bytes, max_steps, rounding, depth, grazing
    cdef readonly int dense_size, taylor_size
    cdef int few_rows, max_passes, max_blocks, first_doublings, max_order
    cdef readonly int max_halvings
    cdef double negligible_power
    cdef readonly double max_step_angle
    cdef readonly Py_ssize_t[::1] used
    cdef Py_ssize_t find(self, signed char[:, ::1] states, Py_ssize_t k) noexcept nogil

cdef class FlowSeries(FlowArrays):
    cdef double[:, ::1] _own
    cdef void derive(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t a, double[:, ::1] z, Py_ssize_t b) noexcept nogil
    cdef void extend(self, Py_ssize_t slot, double[:, ::1] z, Py_ssize_t last, double step, double[:, ::1] y, bint graded) noexcept nogil

cdef class ForcedFlows(FlowSeries):
    cdef double[::1] whole
    cdef int refresh(self, Py_ssize_t slot) except -1 nogil
    cdef int fill_columns(self, Py_ssize_t slot, Py_ssize_t last) except -1 nogil
    cdef void _one_step(self, Py_ssize_t slot) noexcept nogil
    cdef void _sum_terms(self, Py_ssize_t slot, Py_ssize_t h) noexcept nogil
    cdef void _add_term(self, Py_ssize_t slot, Py_ssize_t h, int j, double power, double slope) noexcept nogil
    cdef void _sized(self, Py_ssize_t slot) noexcept nogil
    cdef void _double(self, Py_ssize_t slot, Py_ssize_t j) noexcept nogil
    cdef void free(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) noexcept nogil

cdef class ExitFunctions(ForcedFlows):
    cdef double[:, ::1] _rotated
    cdef void _angles(self, Py_ssize_t slot) noexcept nogil
    cdef void _of_exit(self, Py_ssize_t slot, Py_ssize_t e, int a) noexcept nogil
    cdef void expand(self, Py_ssize_t slot, Py_ssize_t e) noexcept nogil
    cdef void make_columns(self, Py_ssize_t slot, Py_ssize_t steps) noexcept nogil
    cdef void watch(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, Py_ssize_t steps, double[::1] seen) noexcept nogil
    cdef void leave(self, Py_ssize_t slot, Py_ssize_t e, double[:, ::1] y, Py_ssize_t k, double[:, ::1] powers) noexcept nogil

cdef double value(double[::1] powers, int order, double x) noexcept nogil
cdef double root(double[::1] powers, int order, double low, double high) noexcept nogil
cdef int needed(double x) noexcept nogil
cdef void summed(double[:, ::1] terms, double x, double[:, ::1] y, Py_ssize_t k) noexcept nogil

cdef class Flows(ExitFunctions):
    cdef int advance(self, Py_ssize_t slot, Py_ssize_t j, double[:, ::1] y, Py_ssize_t k) except -1 nogil
    cdef int carry(self, Py_ssize_t slot, double position, double[:, ::1] y, Py_ssize_t k) except -1 nogil
    cdef void bound(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[::1] out) noexcept nogil
    cdef void taylor(self, Py_ssize_t slot, double[:, ::1] y, Py_ssize_t k, double[:, ::1] terms) noexcept nogil
    cdef void part(self, Py_ssize_t slot, double x, double[:, ::1] y, Py_ssize_t first, Py_ssize_t last) noexcept nogil
