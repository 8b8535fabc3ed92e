"""How exactly the motion of a contact in its plane is followed."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class PlanarOptions:
    """Tolerances and limits of the kernel of contacts in a plane; angles in radians.

    Of the panels by which slip is followed
    ---------------------------------------
    tolerance : what the last coefficient of a panel's polynomial may be, times its radius over the greatest.
        Forces err by about 1e-3 of that, their derivatives by more, see below.
    resolved : how long a panel may be, times the highest harmonic that is integrated.
    before : of the last coefficient but one, what the last is taken for at least, as it may vanish by chance.
    converged : a change of t in Newton's method after which one more step, of about its square, is the last.
    settled : a change after which there is none.
    newton : steps of it; where it takes more, the panel is too long.
    steepest : t at the end of a panel, at most, to begin with.
    widest : of t; directions are then within 100 degrees of that at the start.
    growth : exponent by which directions may part in a panel.
    varied : times the derivative of the force by the direction at the start of a panel, the last coefficient
        of how that goes on, and likewise; where derivatives are wanted.
    light : times the length of a panel, where the load is small: tolerance of derivatives there.
    shrink, grow, safety : limits of the ratio of two lengths, and what it is multiplied by.
    near : before it opens, times the highest harmonic, panels are graded towards that.
    ends : times the tolerance, the force that a last panel is left, up to where it opens.
    unturned : the derivative of the impulse by the direction that is left then, where derivatives are wanted.
    deepest : of what is left until it opens, a graded panel takes at most.
    nothing : of its bound, a radius that is none.
    negligible : before it opens, where the force adds nothing any more.

    Of sticks
    ---------
    shortest : of a step, or of a slip.
    first_step : from the start of a stick, at least; doubled while no slip follows it.
    on_edge : of the square of the radius, by which a slider within its disc lies on the edge of it.

    Of steady cycles
    ----------------
    periods : that are gone through in search of one.
    double_point : of the radius, by which a slider may be off after a period that nothing improves: at the
        slip limit itself the fixed point is double, and as uncertain as the square root of the rounding.
    slight : of the radius, by which the discs miss one place where a slider hardly slips.
    inside : of the radius, by which that place lies within one of the discs, at least.
    hardly : of the radius, a way in a period that is summed, and no difference of places.

    Of a slider at rest, and of what is told
    ----------------------------------------
    exchanges : of the discs that hold it.
    missed_part : of the motion and the radius, by which it may lie outside a disc that no sample tells of.
    same : half of what is between two discs that are one.
    steps : to a radian of the highest harmonic, between which an extreme is sought.
    invisible : a state that is shorter is rounding.
    smooth : of a disc beside the motion, which is then as none.
    faint : motion that is smaller than its mean by that is none.
    """

    tolerance: float = 5e-8
    resolved: float = 6.0
    before: float = 0.1
    converged: float = 3e-5
    settled: float = 1e-10
    newton: int = 12
    steepest: float = 0.6
    widest: float = 1.2
    growth: float = 2.0
    light: float = 1.0
    varied: float = 3e-5
    shrink: float = 0.2
    grow: float = 2.5
    safety: float = 0.7
    near: float = 1.0
    ends: float = 1e-3
    unturned: float = 1e-9
    deepest: float = 0.8
    nothing: float = 1e-12
    negligible: float = 1e-10
    shortest: float = 1e-13
    first_step: float = 1e-8
    on_edge: float = 1e-12
    periods: int = 100
    double_point: float = 1e-9
    slight: float = 0.02
    inside: float = 0.1
    hardly: float = 1e-3
    exchanges: int = 100
    missed_part: float = 1e-11
    same: float = 1e-6
    steps: float = 12.0
    invisible: float = 1e-12
    smooth: float = 1e-14
    faint: float = 1e-150


OPTIONS = PlanarOptions()  # of a balance: forces within 1e-10, derivatives 1e-8 mostly, 1e-6 at worst
FINE = replace(
    OPTIONS, tolerance=1e-9, resolved=4.0, deepest=0.6, converged=1e-6, varied=1e-3, unturned=1e-11
)  # of `planar_forces`: forces within 1e-11, derivatives 1e-8
FINEST = replace(FINE, tolerance=1e-11)  # of a loop, whose polynomials are read between the ends of panels
