from fcm.contact.cycle cimport Cycle
from fcm.contact.law cimport Law

cdef class Boundaries(Law):
    cdef Cycle cycle
