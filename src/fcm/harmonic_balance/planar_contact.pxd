from fcm.contact.plane.forces cimport PlanarContact
from fcm.contact.plane.margins cimport PlanarMargins
from fcm.contact.plane.measures cimport PlanarMeasures
from fcm.harmonic_balance.contact_law cimport Law

cdef class Planar(Law):
    cdef public PlanarContact kernel
    cdef public PlanarMargins bounds
    cdef PlanarMeasures measures
    cdef int forces(self, double[::1] x, Py_ssize_t first, bint tangent) except -1
