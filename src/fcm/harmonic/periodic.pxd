from fcm.contact.periodic.forces cimport PeriodicContact
from fcm.contact.periodic.margins cimport Margins
from fcm.harmonic.law cimport Law

cdef class Periodic(Law):
    cdef public PeriodicContact kernel
    cdef public Margins bounds
