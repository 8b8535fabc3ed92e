from fcm.contact.periodic.forces cimport PeriodicContact
from fcm.harmonic.law cimport Law

cdef class Periodic(Law):
    cdef public PeriodicContact kernel
