"""Tolerances and limits of harmonic balance.

`HarmonicBalanceOptions` has all but those of the condensation, which are in `modal_condensation`. The options
are an argument of `System`, and everything computed from a system uses them.
"""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class ExtremeOptions(Frozen):
    """Options on how the greatest and the least value of a motion over the cycle are found.

    Attributes
    ----------
    samples : int
        Number of samples for each period of the highest harmonic, from which the search for an extreme
        starts.
    max_steps : int
        Most Newton steps from a sample to the extreme next to it.
    max_iterations, angle_tolerance : int, float
        Most Newton steps from the extreme of a nearby motion, and the length [rad] of a step that is the
        last: the error of the value is of the order of its square.
    step_tolerance : float
        [rad] Length of a Newton step from a sample after which the angle is accepted: its error is of the
        order of the square of that step.
    block : int
        Number of degrees of freedom that are sampled together, so that their samples stay in the processor's
        cache.
    many_dofs : int
        Number of degrees of freedom above which BLAS computes sums over modes and harmonics.
    """

    samples: int = 12
    max_steps: int = 4
    max_iterations: int = 8
    angle_tolerance: float = 1e-9
    step_tolerance: float = 1e-6
    block: int = 256
    many_dofs: int = 50


class SpectrumOptions(Frozen):
    """Options on which harmonics of the exact forces are computed, and at which points.

    Attributes
    ----------
    highest_factor : float
        Least ratio of the highest harmonic computed of the exact forces to the highest of the balance.
    few_products : int
        Number of modes times ports up to which a sum over them is faster without BLAS.
    leading_share : float
        Share of a harmonic that is in resonance with a mode, relative to the greatest share at that point,
        above which it leads there.
    point_interval : int
        Interval, in points of a curve, at which the exact forces are computed with many modes or contacts.
    least_amplitude : float
        Least amplitude that a share is relative to, as a part of the greatest amplitude of all degrees of
        freedom.
    min_further, max_further : int
        Least and greatest number of harmonics that an enriched motion has beyond the highest balanced one;
        between them the number equals that harmonic.
    compiled_ports : int
        Number of ports up to which the equations of one harmonic are solved without leaving compiled code.
    """

    highest_factor: float = 1.5
    few_products: int = 1000
    leading_share: float = 0.5
    point_interval: int = 16
    least_amplitude: float = 1e-9
    min_further: int = 6
    max_further: int = 15
    compiled_ports: int = 20


class DigitOptions(Frozen):
    """Options on where the loss of digits by rounding is estimated, and how.

    Attributes
    ----------
    stiff_ratio : float
        Ratio k |G| of a contact's stiffness to that of the structure, above which rounding is estimated.
    last_digit : float
        Relative rounding error of a number: that of float64.
    summed_roundings : float
        Number of rounding errors that are assumed to add up in a sum.
    max_points : int
        Most points of a curve at which rounding is estimated, where contacts are many.
    min_unknowns : int
        Number of unknowns from which on no inverse is computed: errors are estimated from random signs.
    max_signs : int
        Number of vectors of errors with random signs in that estimate.
    deviation_factor : float
        Greatest error in that estimate, relative to the root of the mean square of the errors.
    max_condition : float
        Condition number of the receptance matrix G from which on its inverse is not used.
    """

    stiff_ratio: float = 1e4
    last_digit: float = 2.2e-16
    summed_roundings: float = 4.0
    max_points: int = 16
    min_unknowns: int = 200
    max_signs: int = 8
    deviation_factor: float = 3.0
    max_condition: float = 1e10


class StiffContactOptions(Frozen):
    """Options on when a lower contact stiffness is advised, by k |G|.

    k |G| is the stiffness of a contact relative to that of the structure there.

    Attributes
    ----------
    max_stiffness : float
        k |G| above which a lower stiffness is advised: with stiffer contacts curves were seen to stop.
    rigid_stiffness : float
        k |G| of the advised stiffness, with which a contact is nearly rigid: 1 / sqrt(k |G|) is 0.001.
    max_stiffness_in_time, rigid_stiffness_in_time : float
        The two limits above for integration in time, which takes far longer with stiffer contacts.
    """

    max_stiffness: float = 1e7
    rigid_stiffness: float = 1e6
    max_stiffness_in_time: float = 1e6
    rigid_stiffness_in_time: float = 1e5


class StaticLoadOptions(Frozen):
    """Options on how the equilibrium under static loads is found, as their share grows to 1.

    Attributes
    ----------
    initial_share : float
        Share of the static loads at which the curve starts.
    min_share_unit : float
        Least unit of the share along the curve; a greater share is its own unit.
    max_step : float
        Longest step along the curve of the share, in scaled unknowns.
    balance_tolerance : float
        Sum of the forces along a rigid-body mode, relative to their sizes, below which they are in
        equilibrium.
    """

    initial_share: float = 1e-3
    min_share_unit: float = 0.1
    max_step: float = 0.2
    balance_tolerance: float = 1e-6


class RigidMotionOptions(Frozen):
    """Options on when a rigid-body mode makes a motion undetermined, or no steady state.

    Attributes
    ----------
    friction_tolerance : float
        Mean friction on a mode, relative to the amplitude of the contact forces on it, below which it counts
        as none.
    load_tolerance : float
        Mean normal force of a contact, relative to that of the same contact if it were glued, below which it
        counts as none.
    """

    friction_tolerance: float = 1e-9
    load_tolerance: float = 1e-8


class EvaluationCost(Frozen):
    """Seconds that an evaluation of the balance takes, on a core on which numpy's sine takes 10 ns a number.

    Attributes
    ----------
    cycle : float
        [s] for each contact that slips, times one plus the number of harmonics.
    entry : float
        [s] for each entry of the contacts' tangents and of the matrix, to fill, copy and solve.
    system : float
        [s] times the third power of the number of unknowns solved for: a third of a multiplication.
    """

    cycle: float = 1.4e-6
    entry: float = 3e-9
    system: float = 1.8e-11


class WorkOptions(Frozen):
    """Options on how long more harmonics may take, in seconds of the core of `EvaluationCost`.

    Attributes
    ----------
    max_seconds : float
        [s] Most work of all rounds with more and more harmonics: levels, branches and errors. Above it no
        further round begins.
    max_seconds_repeated : float
        [s] This limit where curves are followed a dozen times, as in a search, or with one harmonic more each
        time.
    """

    max_seconds: float = 30.0
    max_seconds_repeated: float = 3.0


class WorkspaceOptions(Frozen):
    """Options on which workspaces are kept for the next system, as in a sweep.

    Attributes
    ----------
    max_size : int
        Number of contacts times harmonics up to which a workspace is kept.
    max_count : int
        Most workspaces that are kept in each thread; the oldest is dropped.
    """

    max_size: int = 20
    max_count: int = 16


class UnitOptions(Frozen):
    """Options on the units in which displacements are measured along a curve.

    Attributes
    ----------
    own_fraction : float
        Least unit of a displacement, relative to its own greatest value so far.
    greatest_fraction : float
        Least unit of a displacement, relative to the greatest value of all displacements.
    preload_fraction : float
        Least unit of a normal displacement, relative to n_0 / k_v. The rounding error of the preload is then
        50 times less than `NewtonOptions.max_rounding`.
    min_contacts : int
        Number of contacts from which on all displacements have one unit. A contact then counts by its motion
        relative to the others, and its corners turn the curve by no more than that.
    min_level_unit : float
        Least unit of the level of the forces; a greater level is its own unit.
    """

    own_fraction: float = 0.1
    greatest_fraction: float = 1e-6
    preload_fraction: float = 1e-8
    min_contacts: int = 12
    min_level_unit: float = 0.1


class DampedOptions(Frozen):
    """The damped Newton method for many contacts; lengths of steps are relative to the motion.

    Attributes
    ----------
    min_contacts : int
        Number of contacts from which on Newton's method is damped.
    max_steps : int
        Number of steps after which a guess is given up as too far away.
    min_damping : float
        Least damping factor of a step; if a smaller one is needed, the method diverges.
    min_factor, max_factor : float
        Least ratio by which a step is shortened at once, and greatest ratio of a step's first damping factor
        to that of the step before.
    final_step : float
        Length of a step below which it is the last.
    """

    min_contacts: int = 12
    max_steps: int = 16
    min_damping: float = 1e-3
    min_factor: float = 0.1
    max_factor: float = 4.0
    final_step: float = 1e-9


class ProlongationOptions(Frozen):
    """Options on the prolongation of a point to the balance with more harmonics.

    Steps are relative to the size of the solution.

    Attributes
    ----------
    max_iterations : int
        Number of Newton steps after which a guess is given up as too far away.
    final_step : float
        Length of a Newton step below which it is the last.
    max_change : float
        Change of the displacements, relative to the solution's size, beyond which the solution is a different
        one.
    min_cosine : float
        Cosine between the directions of the two curves, below which the solution lies on another part.
    homotopy_parts : tuple of float
        Homotopy parameters, in turn, where Newton's method fails to converge at once.
    costly_size : int
        Number of unknowns from which on no homotopy is tried. Hundreds of homotopies there found nothing.
    chord_size : int
        Number of unknowns from which on chord steps are always tried: a Jacobian takes far longer than a
        residual.
    chord_step : float
        Length of a Newton step below which the same Jacobian is used for the next ones.
    max_chord_steps : int
        Most Newton steps in a row with the same Jacobian.
    chord_contraction : float
        Length of a chord step, relative to the one before, from which on the Jacobian is computed anew.
    first_step_ratio : float
        Length of the first Newton step of a costly problem, relative to `max_change`, beyond which it is
        given up as diverging.
    damped : DampedOptions
        Options of Newton's method for many contacts.
    """

    max_iterations: int = 8
    final_step: float = 1e-12
    max_change: float = 0.5
    min_cosine: float = 0.7
    homotopy_parts: tuple[float, ...] = (0.1, 0.25, 0.45, 0.7, 1.0)
    costly_size: int = 240
    chord_size: int = 100
    chord_step: float = 0.02
    max_chord_steps: int = 4
    chord_contraction: float = 0.4
    first_step_ratio: float = 2.0
    damped: DampedOptions = field(default_factory=DampedOptions)


class HarmonicBalanceOptions(Frozen):
    """All options of the harmonic balance of a `System`.

    Attributes
    ----------
    extremes, spectrum, digits, stiff, rest, rigid, cost, work, workspace, units
        Options of the parts, each of a class of its own.
    samples : int
        Least number of samples for each period of the highest harmonic, where a contact law of one's own is
        sampled over the cycle.
    own_law_changes : float
        Difference of the changes of a contact law of one's own from central differences, relative to the
        greatest of them, above which the law is refused.
    """

    extremes: ExtremeOptions = field(default_factory=ExtremeOptions)
    spectrum: SpectrumOptions = field(default_factory=SpectrumOptions)
    digits: DigitOptions = field(default_factory=DigitOptions)
    stiff: StiffContactOptions = field(default_factory=StiffContactOptions)
    rest: StaticLoadOptions = field(default_factory=StaticLoadOptions)
    rigid: RigidMotionOptions = field(default_factory=RigidMotionOptions)
    cost: EvaluationCost = field(default_factory=EvaluationCost)
    work: WorkOptions = field(default_factory=WorkOptions)
    workspace: WorkspaceOptions = field(default_factory=WorkspaceOptions)
    units: UnitOptions = field(default_factory=UnitOptions)
    samples: int = 8
    own_law_changes: float = 1e-3


HARMONIC_BALANCE = HarmonicBalanceOptions()  # the default
PROLONGATION = ProlongationOptions()
MIN_AMPLITUDE = 1e-150  # least amplitude in a division: its square does not underflow
