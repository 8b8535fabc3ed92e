from fcm.continuation.stepper cimport Stepper

cdef bint crosses(Stepper stepper) except -1
cdef bint even(Stepper stepper) except -1
cdef double dip(Stepper stepper) except -1
cdef double detour(Stepper stepper, double[::1] greatest) except -1
cdef double turning(Stepper stepper) except -1
cdef double opposite(double rise, double begin, double end, double least, double doubtful) noexcept nogil
cdef double lowest(double before, double begin, double after, double end) noexcept nogil
cpdef double ahead(Stepper stepper, double step) except -1
cdef double straight_ahead(Stepper stepper) except -1
cdef double label_ahead(Stepper stepper, double step) except -1
cdef bint crossed(Stepper stepper, double step) except -1
