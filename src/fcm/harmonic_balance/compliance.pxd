from fcm.structure.receptance cimport Receptance

cdef void times_forces(Receptance seen, double[::1] force, double[::1] out) noexcept
cdef void times_tangents(Receptance seen, double[:, :, ::1] tangent, double[:, ::1] out) noexcept
cdef void slope(Receptance seen, double[::1] force, double load, double[::1] out) noexcept
cdef void less_external(Receptance seen, double load, double[::1] out) noexcept
cdef void less_external_slopes(Receptance seen, double load, double[::1] out) noexcept
