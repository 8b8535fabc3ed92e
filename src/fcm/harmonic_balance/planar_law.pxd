from fcm.contact.plane.forces cimport PlanarContact
from fcm.contact.plane.margins cimport PlanarMargins, PlanarMeasures
from fcm.harmonic_balance.contact_law cimport KernelLaw

cdef class PlanarLaw(KernelLaw):
    cdef public PlanarContact kernel
    cdef public PlanarMargins bounds
    cdef PlanarMeasures measures
