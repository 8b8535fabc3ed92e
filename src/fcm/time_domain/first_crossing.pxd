cdef double first_descent(double[:, ::1] powers, Py_ssize_t k, double floor, double[:, ::1] work) noexcept nogil
