from fcm.structure.receptance cimport Receptance

cdef class TravellingReceptance(Receptance):
    cdef public list waves
    cdef void from_real(self, int j, Receptance wave) noexcept
