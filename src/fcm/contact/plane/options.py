"""How exactly the motion of a contact in its plane is followed."""

from __future__ import annotations

from dataclasses import replace

from fcm.frozen import Frozen


class PlanarOptions(Frozen):
    """Tolerances and limits of the kernel of contacts in a plane; angles in radians.

    Of the panels by which slip is followed
    ---------------------------------------
    tolerance : what the last coefficient of a panel's polynomial may be, times its radius over the greatest.
        Forces err by about 1e-5 of that, 1e-3 at worst, their derivatives by more, see below.
    panel_length : how long a panel may be, times the highest harmonic that is integrated.
    coefficient_floor : of the last coefficient but one, what the last is taken for at least, as it may vanish
        by chance.
    last_change : one more step of Newton's method is the last where the change of t that it will make is less
        than the square of this.
    zero_change : a change after which there is none.
    frozen_change : a change after which the derivatives of the equations are kept.
    max_iterations : steps of it; where it takes more, the panel is too long.
    max_initial_tangent : t at the end of a panel, at most, to begin with.
    max_tangent : of t; directions are then within 100 degrees of that at the start.
    max_growth : exponent by which directions may part in a panel.
    derivative_fraction : what its derivatives leave out counts by this part of what the polynomial does;
        where derivatives are wanted.
    light_load_tolerance : times the length of a panel, where the load is small: tolerance of derivatives
        there.
    min_factor, max_factor, safety : limits of the ratio of two lengths, and what it is multiplied by.
    grading_length : before it opens, times the highest harmonic, panels are graded towards that.
    end_factor : times the tolerance, the force that a last panel is left, up to where it opens.
    impulse_tolerance : the derivative of the impulse by the direction that is left then, where derivatives
        are wanted.
    max_grading : of what is left until it opens, a graded panel takes at most.
    zero_radius : of its bound, a radius that is none.
    negligible_length : before it opens, where the force adds nothing any more.

    Of sticks
    ---------
    min_step : of a step, or of a slip.
    first_step : from the start of a stick, at least; doubled while no slip follows it.
    edge_tolerance : of the square of the radius, by which a slider within its disc lies on the edge of it.

    Of steady cycles
    ----------------
    max_periods : that are gone through in search of one.
    double_point_tolerance : of the radius, by which a slider may be off after a period that nothing improves:
        at the slip limit itself the fixed point is double, and as uncertain as the square root of the
        rounding.
    slight_miss : of the radius, by which the discs miss one place where a slider hardly slips.
    min_depth : of the radius, by which that place lies within one of the discs, at least.
    min_way : of the radius, a way in a period that is summed, and no difference of places.

    Of a slider at rest, and of what is told
    ----------------------------------------
    max_exchanges : of the discs that hold it.
    max_halvings : of a step between two nodes, after which its cubic is exact.
    disc_tolerance : half of what is between two discs that are one.
    min_bend : of the distance by which it is within a disc, over the radius: less, and no angle is its own.
    samples_per_radian : to a radian of the highest harmonic, between which an extreme is sought.
    min_state_length : a state that is shorter is rounding.
    smooth_radius : of a disc beside the motion, which is then as none.
    min_motion : motion that is smaller than its mean by that is none.
    """

    tolerance: float = 2e-7
    panel_length: float = 6.0
    coefficient_floor: float = 0.1
    last_change: float = 3e-5
    zero_change: float = 1e-10
    frozen_change: float = 0.1
    max_iterations: int = 12
    max_initial_tangent: float = 0.6
    max_tangent: float = 1.2
    max_growth: float = 2.0
    light_load_tolerance: float = 1.0
    derivative_fraction: float = 1e-3
    min_factor: float = 0.2
    max_factor: float = 2.5
    safety: float = 0.7
    grading_length: float = 1.0
    end_factor: float = 0.1
    impulse_tolerance: float = 1e-9
    max_grading: float = 0.97
    zero_radius: float = 1e-12
    negligible_length: float = 1e-10
    min_step: float = 1e-13
    first_step: float = 1e-8
    edge_tolerance: float = 1e-12
    max_periods: int = 100
    double_point_tolerance: float = 1e-9
    slight_miss: float = 0.02
    min_depth: float = 0.1
    min_way: float = 1e-3
    max_exchanges: int = 100
    max_halvings: int = 20
    disc_tolerance: float = 1e-6
    min_bend: float = 1e-3
    samples_per_radian: float = 12.0
    min_state_length: float = 1e-12
    smooth_radius: float = 1e-14
    min_motion: float = 1e-150


class LoopOptions(Frozen):
    """How a loop is read from a cycle.

    recorded_panels : of slip that are recorded at first.
    angles_per_harmonic : of the highest harmonic, at which the greatest force is looked for.
    """

    recorded_panels: int = 1000
    angles_per_harmonic: int = 64


LOOP = LoopOptions()
OPTIONS = PlanarOptions()  # of a balance: forces within 1e-10, derivatives 1e-8 mostly, 1e-6 at worst
FINE = replace(
    OPTIONS,
    tolerance=1e-9,
    panel_length=4.0,
    last_change=1e-6,
    impulse_tolerance=1e-11,
)  # of `planar_forces`: forces within 1e-11, derivatives 1e-8
FINEST = replace(FINE, tolerance=1e-11)  # of a loop, whose polynomials are read between the ends of panels
