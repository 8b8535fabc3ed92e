"""Tolerances and limits of harmonic balance.

`HarmonicBalanceOptions` has them all, but for those of the condensation of many contacts, which are in
`modal_condensation`.
They are an argument of `System`, and what is computed of a system takes its options.
"""

from __future__ import annotations

from dataclasses import field

from fcm.frozen import Frozen


class ExtremeOptions(Frozen):
    """How the greatest and the least value of a motion over the cycle are found.

    Attributes
    ----------
    samples : int
        Angles for each period of the highest harmonic, among which extremes are sought.
    max_steps : int
        Of Newton's method from a sample to the extreme.
    max_iterations, angle_tolerance : int, float
        The same from where an extreme was for a motion nearby, at most; and the angle [rad] of the last, at
        which the value errs by its square.
    step_tolerance : float
        [rad] of the last of the `max_steps`, after which the angle errs by its square.
    block : int
        Degrees of freedom whose samples lie in the processor's cache.
    many_dofs : int
        Degrees of freedom from which on sums over modes and waves are BLAS's.
    """

    samples: int = 12
    max_steps: int = 4
    max_iterations: int = 8
    angle_tolerance: float = 1e-9
    step_tolerance: float = 1e-6
    block: int = 256
    many_dofs: int = 50


class SpectrumOptions(Frozen):
    """Which harmonics of the exact forces are looked at, and at which points.

    Attributes
    ----------
    highest_factor : float
        Times the highest of a balance that is looked at in any case: to have all is not to be exact.
    few_products : int
        Modes times ports, up to which a sum over them is faster without BLAS.
    leading_share : float
        Part of the greatest share, from which on one that meets a mode leads.
    point_interval : int
        Points of a curve from one to the next whose forces are those of all, where there are many.
    least_amplitude : float
        Part of the greatest amplitude of all degrees of freedom, to which a share is referred at least.
    min_further, max_further : int
        Harmonics of an enriched motion beyond the highest that was balanced: as many again, within these.
    compiled_ports : int
        Up to which the equations of one of them are solved without leaving compiled code.
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
    """Where digits are counted, and how many are lost.

    Attributes
    ----------
    stiff_ratio : float
        k |G| of a contact from which digits are counted.
    last_digit : float
        Relative rounding of a number: that of float64.
    summed_roundings : float
        Roundings that come together in a sum.
    max_points : int
        Of a curve of many contacts that are looked at.
    min_unknowns : int
        From which on contacts are many, of which no inverse is made.
    max_signs : int
        Of errors that are looked at together then.
    deviation_factor : float
        Times the root of their mean square, that an error is then taken to be at most.
    max_condition : float
        Condition number of G from which its inverse is no good.
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
    """Contacts so stiff that another stiffness is advised, by k |G| of the structure there.

    Attributes
    ----------
    max_stiffness : float
        From here on curves were seen to stop.
    rigid_stiffness : float
        Here a contact is nearly rigid: the root of its inverse is a thousandth.
    max_stiffness_in_time, rigid_stiffness_in_time : float
        Both of the motion in time, of which a curve then takes long, and seconds.
    """

    max_stiffness: float = 1e7
    rigid_stiffness: float = 1e6
    max_stiffness_in_time: float = 1e6
    rigid_stiffness_in_time: float = 1e5


class StaticLoadOptions(Frozen):
    """How the equilibrium under static loads is found, as their share grows from nearly nothing to 1.

    Attributes
    ----------
    initial_share : float
        Share to begin with.
    min_share_unit : float
        Shares are measured by themselves, and below this by this.
    max_step : float
        Along the curve of the share.
    balance_tolerance : float
        Sum of the forces along a rigid-body mode, relative to their sizes: less is none.
    """

    initial_share: float = 1e-3
    min_share_unit: float = 0.1
    max_step: float = 0.2
    balance_tolerance: float = 1e-6


class RigidMotionOptions(Frozen):
    """When a motion is no steady state, or not determined, because of a rigid-body mode.

    Attributes
    ----------
    friction_tolerance : float
        Mean friction on a mode, relative to the amplitude of the contact forces on it: less is none.
    load_tolerance : float
        Mean normal force of a contact, relative to what it would be if the contact were glued: less is none.
    """

    friction_tolerance: float = 1e-9
    load_tolerance: float = 1e-8


class EvaluationCost(Frozen):
    """Seconds of an evaluation of the balance, of a core on which numpy's sine takes 10 ns a number.

    Attributes
    ----------
    cycle : float
        For the mean and each harmonic of a contact, which slips.
    entry : float
        For each number of the contacts' tangents and of the matrix: filled, copied, solved with.
    system : float
        For each third power of the unknowns that are solved for: 1/3 multiplication.
    """

    cycle: float = 1.4e-6
    entry: float = 3e-9
    system: float = 1.8e-11


class WorkOptions(Frozen):
    """What may be taken for more harmonics, in seconds of the core that `EvaluationCost` is of.

    Attributes
    ----------
    max_seconds : float
        [s] of all rounds of more and more harmonics: levels, branches, errors.
    max_seconds_repeated : float
        [s] where they are followed a dozen times, as in a search, or with one harmonic more each time.
    """

    max_seconds: float = 30.0
    max_seconds_repeated: float = 3.0


class WorkspaceOptions(Frozen):
    """Which workspaces are kept for the next system, as in a sweep.

    Attributes
    ----------
    max_size : int
        Contacts times harmonics, up to which they are.
    max_count : int
        Workspaces of a thread.
    """

    max_size: int = 20
    max_count: int = 16


class UnitOptions(Frozen):
    """In which units displacements are measured along a curve.

    Attributes
    ----------
    own_fraction : float
        Part of its greatest value so far that the unit of a displacement is at least,
    greatest_fraction : float
        and of the greatest of all.
    preload_fraction : float
        Part of n_0 / k_v, that of a normal displacement is at least. What rounding of the preload makes of it
        is then less than `NewtonOptions.max_rounding`, by a factor of 50.
    min_contacts : int
        Of so many and more all displacements have one unit. What a single contact does then matters as far as
        it moves beside the others, and its corners turn the curve by no more than that.
    min_level_unit : float
        A level of the forces is measured by itself, and below this by this.
    """

    own_fraction: float = 0.1
    greatest_fraction: float = 1e-6
    preload_fraction: float = 1e-8
    min_contacts: int = 12
    min_level_unit: float = 0.1


class DampedOptions(Frozen):
    """Of the damped Newton method of many contacts; steps are relative to the motion.

    Attributes
    ----------
    min_contacts : int
        From so many on.
    max_steps : int
        After so many a guess is judged too far away.
    min_damping : float
        A step that is shortened to this part counts as divergence.
    min_factor, max_factor : float
        By this a step is shortened at most at once, and longer than the one before.
    final_step : float
        After one that is no longer there is none.
    """

    min_contacts: int = 12
    max_steps: int = 16
    min_damping: float = 1e-3
    min_factor: float = 0.1
    max_factor: float = 4.0
    final_step: float = 1e-9


class ProlongationOptions(Frozen):
    """How a point is moved to the balance of more harmonics; steps are relative to the solution's size.

    Attributes
    ----------
    max_iterations : int
        Newton steps before a guess is judged too far away.
    final_step : float
        A step after which there is no further one.
    max_change : float
        Part of the solution's size, by which a displacement may change.
    min_cosine : float
        Of the angle by which the curve may turn.
    homotopy_parts : tuple of float
        Parts of the equations' change, where at once is too much.
    costly_size : int
        Unknowns from which on what is not found at once is given up. Hundreds of ways by parts led nowhere.
    chord_size : int
        Unknowns from which on a Jacobian takes far longer than the residual: those of several contacts.
    chord_step : float
        A step so short that the Jacobian hardly changes along it.
    max_chord_steps : int
        Steps with one Jacobian then.
    chord_contraction : float
        Part of the step before, that each of these may be.
    first_step_ratio : float
        Times `max_change`, beyond which the first step of a costly problem counts as divergence.
    damped : DampedOptions
        Of many contacts.
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
    """What a `System` is computed with.

    Attributes
    ----------
    extremes, spectrum, digits, stiff, rest, rigid, cost, work, workspace, units
        Of the parts, each of a class of its own.
    samples : int
        Of a cycle for each period of the highest harmonic, at least, where a contact's own law is sampled.
    own_law_changes : float
        How far the changes of a contact's own law may be from central differences, relative to the greatest.
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


HARMONIC_BALANCE = HarmonicBalanceOptions()  # where nothing else is said
PROLONGATION = ProlongationOptions()
MIN_AMPLITUDE = 1e-150  # amplitudes below count as this in a division: its square is a number still
