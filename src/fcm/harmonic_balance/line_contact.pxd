from fcm.contact.periodic.forces cimport PeriodicContact
from fcm.contact.periodic.margins cimport Margins, Measures
from fcm.harmonic_balance.contact_law cimport KernelLaw

cdef class LineLaw(KernelLaw):
    cdef public PeriodicContact kernel
    cdef public Margins bounds
    cdef Measures measures
