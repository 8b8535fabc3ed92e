cdef class Reflections:
    cdef double[:, ::1] a
    cdef double[::1] v, w
    cdef void reflect(self, Py_ssize_t at, Py_ssize_t count, Py_ssize_t left, Py_ssize_t top, Py_ssize_t bottom, Py_ssize_t end) noexcept
    cdef double aim(self, Py_ssize_t count) noexcept
    cdef void three_rows(self, Py_ssize_t at, Py_ssize_t left, Py_ssize_t end, double weight) noexcept
    cdef void three_columns(self, Py_ssize_t at, Py_ssize_t top, Py_ssize_t bottom, double weight) noexcept
    cdef void rows(self, Py_ssize_t at, Py_ssize_t count, Py_ssize_t left, Py_ssize_t end, double weight) noexcept
    cdef void columns(self, Py_ssize_t at, Py_ssize_t count, Py_ssize_t top, Py_ssize_t bottom, double weight) noexcept
