cdef int NONE

cdef class Problem:
    cdef public int unknowns
    cdef public int margins
    cdef public int outputs
    cdef public int rank
    cdef public int group
    cdef public bint labelled
    cdef public bint has_root_margins
    cdef public bint costly
    cdef public double unbounded
    cdef readonly int costly_size
    cdef readonly double difference_length, max_angle
    cdef public double[::1] residual
    cdef public double[:, ::1] jacobian
    cdef public double[::1] scale
    cdef public double[::1] margin
    cdef public int[::1] kind
    cdef public double[::1] angle
    cdef public double[::1] output
    cdef public double[::1] growth
    cpdef int evaluate(self, double[::1] z) except -1
    cpdef int evaluate_residual(self, double[::1] z) except -1
    cpdef int evaluate_scale(self, double[::1] z) except -1
    cpdef int evaluate_margins(self, double[::1] z) except -1
    cpdef double squared_margin(self, int kind, double[::1] z) except? -1.0
    cpdef int evaluate_outputs(self, double[::1] z, double[::1] direction) except -1
    cpdef double factor(self, double[::1] row, double[::1] scale) except -2.0
    cpdef int solve(self, double[::1] right) except -1
    cpdef double solved_sign(self) except -2.0

cdef class Point:
    cdef public double[::1] z
    cdef public double[::1] tangent
    cdef public double[::1] margin
    cdef public int[::1] kind
    cdef public double[::1] angle
    cdef public double[::1] slope
    cdef readonly Py_ssize_t group
    cdef double max_angle
    cdef public double[::1] output
    cdef public double[::1] growth
    cdef public double orientation
    cdef bint has_margin_slopes
    cdef int set_margins(self, Problem problem) except -1
    cdef int copy_from(self, Point other, double unit) except -1
    cpdef Py_ssize_t matching_margin(self, Py_ssize_t k, int[::1] kind, double[::1] angle) except -2
    cdef Py_ssize_t nearest(self, int wanted, double at, int[::1] kind, double[::1] angle, Py_ssize_t first) noexcept
    cpdef double margin_at(self, Py_ssize_t k, Point other) except -1e300
    cdef double margin_of_problem(self, Py_ssize_t k, Problem problem) except -1e300
    cdef int differentiate_margins(self, Problem problem, double[::1] scale, double[::1] beside) except -1

cdef class PointStore:
    cdef readonly int count
    cdef readonly int size
    cdef double[:, ::1] z
    cdef double[:, ::1] direction
    cdef double[::1] orientation
    cdef long[::1] mark
    cdef int add(self, Point point, double[::1] scale, long mark) except -1
    cpdef int put(self, double[::1] z, double[::1] direction, long mark, double orientation) except -1
    cdef int widen(self) except -1
    cdef bint ends_at(self, Point point) except -1
    cdef bint same(self, Py_ssize_t i, Py_ssize_t k, double part) except -1
    cdef int mark_last(self, long mark) except -1
