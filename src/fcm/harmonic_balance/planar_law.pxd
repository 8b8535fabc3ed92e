from fcm.contact.plane.integrals cimport PlanarIntegrals
from fcm.contact.plane.margins cimport PlanarMargins, PlanarMeasures
from fcm.harmonic_balance.contact_law cimport KernelLaw

cdef class PlanarLaw(KernelLaw):
    cdef readonly PlanarMargins discs
    cdef PlanarIntegrals integrals
    cdef PlanarMeasures measures
