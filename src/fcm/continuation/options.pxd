cdef class Options:
    pass

cdef class NewtonOptions(Options):
    cdef readonly int iterations, chords, kept, halves
    cdef readonly double close, preliminary, small, exact, rough, left, chord, shrinking, brief, hopeless
    cdef readonly double slight, coarsest, roundings

cdef class StepOptions(Options):
    cdef readonly double first, shortest, cosine, sharp, far, turn, miss, uneven, uneven_times, shrink, grow
    cdef readonly double haste, share, after, resumed, shortened
    cdef readonly int most
    cdef readonly tuple back

cdef class EventOptions(Options):
    cdef readonly int most, outputs
    cdef readonly double high, high_of_many, fine, enclosed, rise, nearly_greatest, even, doubtful, blurred, same, same_way, landing

cdef class SwitchingOptions(Options):
    cdef readonly int most, further, pieces, many
    cdef readonly double known, known_label, past, across, met, touched_root, before, touched, near, nearer, beyond, astray

cdef class FollowOptions(Options):
    cdef readonly double max_step
    cdef readonly bint hasty
    cdef readonly NewtonOptions newton
    cdef readonly StepOptions step
    cdef readonly EventOptions events
    cdef readonly SwitchingOptions switching
    cdef readonly object labels
