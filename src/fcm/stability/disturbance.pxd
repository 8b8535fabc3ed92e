cdef class Stiffness:
    cdef readonly int modes, contacts
    cdef bint soft
    cdef readonly double omega, rate
    cdef readonly double[:, ::1] shapes, contact, K, image
    cdef double[:, ::1] S, B, seen, W, work
    cdef readonly double[::1] damping
    cdef double[::1] natural, ratio
    cdef object flexibility
    cdef dict known
    cdef int most
    cdef bint made
    cdef int at(self, double omega) except -1
    cdef int assemble(self, int[::1] state, bytes key) except -1
    cdef int make(self) except -1
    cdef void contacts_alone(self, int[::1] state) noexcept
    cdef void condense(self) noexcept
    cdef void modal(self) noexcept
    cdef int displacement(self, Py_ssize_t port, double[:, ::1] X, double[::1] out) except -1

cdef class EigenExpansion:
    cdef double[::1] re, im
    cdef object share, driven, back
    cdef readonly Py_ssize_t modes, count
    cpdef int carry(self, double time, double omega, object X) except -1
    cdef void grow(self, double time, double[:, ::1] part, double[:, ::1] drive) noexcept

cdef void add_complex_product(double[::1] re, double[::1] im, double[::1] by_re, double[::1] by_im, double times, double times_im) noexcept

cdef class Disturbances:
    cdef readonly Stiffness stiffness
    cdef readonly int modes, contacts, size, memories
    cdef int few, blas_products
    cdef double step_radians, series_tolerance, max_steps, squared_radians
    cdef double[:, ::1] X, term, work, A, E, F
    cdef int[::1] state
    cdef readonly object propagator
    cdef object states, rows, key
    cdef int assemble(self) except -1
    cdef int propagate(self, double length) except -1
    cdef int propagate_by_squaring(self, double length) except -1
    cdef void fill_system(self, double length) noexcept
    cdef int carry(self) except -1
    cdef int product(self, double[:, ::1] left, double[:, ::1] right, double factor) except -1
    cdef int apply(self, double h) except -1
    cdef int add_stiffness(self, Py_ssize_t columns) except -1
    cdef void add_sliders(self, Py_ssize_t columns) noexcept
