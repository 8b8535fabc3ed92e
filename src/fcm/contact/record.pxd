from fcm.contact.cycle cimport Cycle

cdef class Record(Cycle):
    cdef Py_ssize_t point
    cdef double[:, :, ::1] spans
    cdef void take(self) noexcept nogil
