from fcm.harmonic.lifted cimport Lifted

cdef class Displacement:
    cdef public Lifted lifted
    cdef public double missed
