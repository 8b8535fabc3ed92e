from fcm.harmonic_balance.residual cimport Balance
from fcm.harmonic_balance.contact_law cimport Law

cdef class Points:
    cdef readonly Balance balance
    cdef readonly double[:, :, ::1] re
    cdef readonly double[:, :, ::1] im
    cdef readonly double[:, ::1] mean
    cdef readonly double[:, ::1] amplitude
    cdef readonly double[:, ::1] growth
    cdef readonly double[:, ::1] force
    cdef readonly int[::1] linear
