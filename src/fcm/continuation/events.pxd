from fcm.continuation.front cimport Front
from fcm.continuation.place cimport Place

cdef bint quiet(Front front, double[::1] values, double[::1] greatest) except -1
cdef bint turns(Place here, Place there, Py_ssize_t k, double greatest) except -1
cdef bint closes(Front front, double[::1] first, double[::1] head) except -1
