"""Options for a contact that slides in a plane."""

from __future__ import annotations

from dataclasses import replace

from fcm.frozen import Frozen


class PlanarOptions(Frozen):
    """Tolerances and limits of the kernel of contacts in a plane; lengths of panels are angles in radians.

    Panels by which a slip is followed
    ----------------------------------
    tolerance : greatest last coefficient of a panel's polynomial, times its relative radius, at which the
        panel is accepted. Forces err by about 1e-5 of that, 1e-3 at worst; derivatives by more, see below.
    panel_length : longest panel, times the highest harmonic that is integrated.
    coefficient_floor : least value assumed for the last coefficient, relative to the last but one: it may
        vanish by chance.
    last_change : square root of the change of t expected next, below which the next step of Newton's method
        is the last.
    zero_change : change of t in a Newton step, below which there is no further step.
    frozen_change : change of t in a step, up to which the derivatives of the equations are kept for the next.
    max_iterations : most steps of Newton's method; if it needs more, the panel is too long.
    max_initial_tangent : greatest t at the end of a panel in the first guess.
    max_tangent : value of t from which on a panel is too long; below it directions are within 100 degrees of
        that at the start.
    max_growth : exponent by which neighbouring directions may part in a panel; with more it is too long.
    derivative_fraction : weight of the derivatives' error in the error of a panel, if derivatives are
        computed.
    light_load_tolerance : times the length of a panel, the least weight of its error where the load is small,
        for the derivatives there.
    min_factor, max_factor, safety : least and greatest ratio of a panel's length to the last, and factor on
        the length that the tolerance permits.
    grading_length : distance to the opening of the contact, times the highest harmonic, within which panels
        are graded towards it.
    end_factor : force, relative to the tolerance, that a last panel up to the opening may leave out.
    impulse_tolerance : derivative of the impulse by the direction that such a panel may leave out, if
        derivatives are computed.
    max_grading : greatest length of a graded panel, relative to the distance to the opening.
    zero_radius : radius of a disc, relative to its bound, up to which it counts as zero.
    negligible_length : distance to the opening of the contact within which the force contributes nothing.

    Sticks
    ------
    min_step : shortest step of a stick, and shortest slip.
    first_step : shortest first step of a stick; doubled while no slip follows the stick.
    edge_tolerance : distance from the edge of its disc, in terms of the squared radius, up to which a slider
        within it lies on the edge.

    Steady cycles
    -------------
    max_periods : most periods that are followed to find a steady cycle.
    place_tolerance : change of a slider's place in a period, relative to the lesser of radius and motion, up
        to which it is steady.
    next_change : expected next change, relative to that, below which a step of Newton's method is the last.
    max_contraction : change of the place in a period, relative to the one before, from which on Newton's
        method does not help.
    min_determinant : determinant of the derivatives of that change by the place, up to which they are not
        used.
    double_point_tolerance : change of a slider's place in a period, relative to the radius, up to which it is
        steady if nothing improves it: at the slip limit the fixed point is double, and as uncertain as the
        square root of the rounding.
    slight_miss : distance by which the discs miss one place, relative to the radius, below which a slider
        hardly slips.
    min_depth : least depth of that place within one of the discs, relative to the radius.
    min_way : path of a slider in a period, relative to the radius, below which it is summed instead of taken
        as a difference of places.

    Slider at rest, and results
    ---------------------------
    max_exchanges : most exchanges of the discs that hold a slider at rest.
    max_halvings : most halvings of a step between two nodes, after which its cubic is exact.
    disc_tolerance : half the angle between two discs, below which they are the same.
    min_bend : curvature of a slider's distance from the edge of a disc, relative to the radius, below which
        the disc has no angle of its own.
    samples_per_radian : number of samples for each radian of the highest harmonic, among which an extreme is
        sought.
    min_state_length : length of a state below which it is rounding.
    smooth_radius : radius of the disc, relative to the motion, up to which the contact slides without
        friction.
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
    place_tolerance: float = 1e-14
    next_change: float = 0.01
    max_contraction: float = 0.5
    min_determinant: float = 1e-13
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


class LoopOptions(Frozen):
    """Options on how the loop of a cycle is sampled.

    recorded_panels : number of panels of slip that are recorded at first.
    angles_per_harmonic : number of angles for each period of the highest harmonic, at which the greatest
        force is sought.
    """

    recorded_panels: int = 1000
    angles_per_harmonic: int = 64


LOOP = LoopOptions()
OPTIONS = PlanarOptions()  # for a balance: forces within 1e-10, derivatives 1e-8 mostly, 1e-6 at worst
FINE = replace(
    OPTIONS, tolerance=1e-9, panel_length=4.0, last_change=1e-6, impulse_tolerance=1e-11
)  # for `planar_forces`: forces within 1e-11, derivatives 1e-8
FINEST = replace(FINE, tolerance=1e-11)  # for a loop, which evaluates the polynomials within panels
