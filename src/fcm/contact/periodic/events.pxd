from fcm.contact.periodic.motion cimport Motion

cdef int CLOSES, OPENS, TOP, BOTTOM, MEETS

cdef class Events:
    cdef readonly Motion motion
    cdef readonly int events
    cdef readonly int[::1] event_kind
    cdef readonly double[::1] event_cos, event_sin, event_angle, lower, upper, moved
    cdef readonly double[::1] lower_rate, upper_rate, load_rate, motion_rate, margin
    cdef int place(self, double theta, int kind) noexcept nogil
