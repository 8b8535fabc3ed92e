"""How short a step is that may lead round a corner of the curve."""

# In the scale of the problem. A longer step runs along a smooth piece: one that turns by more than the step
# rule allows is refused and shortened. A shorter one would not turn by less: there is a corner that no margin
# tells of, and the step may turn by any angle below a right angle.
SHARP = 1e-4
