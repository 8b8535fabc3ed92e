from fcm.continuation.problem cimport Problem
from fcm.harmonic_balance.contact_law cimport Law
from fcm.harmonic_balance.displacement cimport Displacements
from fcm.harmonic_balance.modal_equations cimport ModalCompliance
from fcm.structure.receptance cimport Receptance

cdef void apply_to_forces(Receptance receptance, double[::1] force, double[::1] out) noexcept
cdef void apply_to_tangents(Receptance receptance, double[:, :, ::1] tangent, double[:, ::1] out) noexcept
cdef void slope(Receptance receptance, double[::1] force, double load, double[::1] out) noexcept
cdef void apply_to_waves(Receptance receptance, double[:, :, ::1] G_re, double[:, :, ::1] G_im, double[::1] force, double[::1] out) noexcept
cdef void subtract_external(Receptance receptance, double[:, ::1] X_re, double[:, ::1] X_im, double load, double[::1] out) noexcept

cdef class Balance(Problem):
    cdef public Receptance receptance
    cdef public Displacements displacements
    cdef public list laws
    cdef public object condensed
    cdef ModalCompliance answer
    cdef public object layout
    cdef public int contacts
    cdef public int directions
    cdef public int ports
    cdef public int width
    cdef public double span
    cdef public double load
    cdef public double share
    cdef public double[::1] rest
    cdef public double[::1] reported
    cdef public double[::1] counted
    cdef public double[::1] force
    cdef public double[:, :, ::1] tangent
    cdef public double[::1] largest
    cdef double[::1] size
    cdef double own
    cdef double greatest
    cdef double of_preload
    cdef bint alike
    cdef public double[::1] evaluated
    cdef double[::1] now
    cdef double[::1] rate
    cdef double[::1] by_frequency
    cdef int forces_at(self, double[::1] z, double[::1] direction) except -1
    cdef int evaluate_contacts(self, double[::1] z, bint tangents) except -1
    cdef int slopes(self) except -1
    cdef int together(self) except -1
    cdef int contact_forces(self, double[::1] z, bint tangents) except -1

cdef class PointQuantities:
    cdef readonly Balance balance
    cdef readonly double[:, :, ::1] re
    cdef readonly double[:, :, ::1] im
    cdef readonly double[:, ::1] mean
    cdef readonly double[:, ::1] amplitude
    cdef readonly double[:, ::1] growth
    cdef readonly double[:, ::1] force
    cdef readonly int[::1] linear
