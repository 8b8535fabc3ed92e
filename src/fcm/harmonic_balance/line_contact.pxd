from fcm.contact.periodic.forces cimport PeriodicContact
from fcm.contact.periodic.margins cimport Margins, Measures
from fcm.harmonic_balance.contact_law cimport Law

cdef class Periodic(Law):
    cdef public PeriodicContact kernel
    cdef public Margins bounds
    cdef Measures measures
    cdef int forces(self, double[::1] x, Py_ssize_t first, bint tangent) except -1
