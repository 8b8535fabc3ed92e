"""The tolerances and limits with which responses are calculated and reported."""

from __future__ import annotations

from dataclasses import replace

from fcm.accuracy.options import REFINEMENT, RefinementOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.options import HARMONIC_BALANCE, HarmonicBalanceOptions
from fcm.reduction.options import REDUCTION, ReductionOptions
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.tracking.options import SEARCH, SearchOptions


class InputLimits(Frozen):
    """What is asked for and is more likely a mistake than meant.

    Attributes
    ----------
    accuracy : float
        Relative, of peaks and folds, where nothing else is said.
    max_frequency_ratio : float
        Times the highest natural frequency, beyond which a frequency is a mistake of units.
    max_level : float
        Level of the forces, beyond which it is a mistake of units.
    min_level : float
        Level of the forces, below which the structure does not move.
    max_amplitude_ratio : float
        Greatest ratio of the ends of a span of amplitudes.
    min_relative_width : float
        Relative width of a span: of a narrower one not even the first steps are more than rounding.
    """

    accuracy: float = 1e-2
    max_frequency_ratio: float = 1e6
    max_level: float = 1e6
    min_level: float = 1e-3
    max_amplitude_ratio: float = 1e15
    min_relative_width: float = 1e-6


INPUT_LIMITS = InputLimits()


class SentenceOptions(Frozen):
    """How many things one sentence names.

    Attributes
    ----------
    max_dofs, max_harmonics, max_frequencies : int
        Of each kind at most.
    low_peak : float
        Share of the greatest peak, below which it is said of the peak with the greatest error how low it is.
    max_states : int
        Letters of a sequence of contact states: a contact that chatters has more, and the rest is cut off.
    resonance_tolerance : float
        Relative distance of a harmonic's frequency from a resonance, up to which a curve stops at that.
    spring_ratio : float
        Times below that resonance the spring to the ground is that is advised: it shifts it by 1/1800.
    contacts_in_time : int
        With more nobody is sent to the exact motion: a frequency takes minutes.
    """

    max_dofs: int = 3
    max_harmonics: int = 6
    max_frequencies: int = 5
    low_peak: float = 0.1
    max_states: int = 60
    resonance_tolerance: float = 1e-5
    spring_ratio: float = 30.0
    contacts_in_time: int = 12


SENTENCES = SentenceOptions()


class SweepOptions(Frozen):
    """How the curves of a sweep are traced.

    Attributes
    ----------
    batch : int
        Curves that are finished or interrupted together.
    expected_harmonic : int
        Harmonic that is expected to be the highest, where an accuracy decides.
    traced_share : float
        Share of the progress bar at which the curves are traced; then they are checked.
    max_rounds : int
        Of more harmonics, after which what is left is said.
    save_interval : float
        [s] after which finished curves are saved before their group is, and no kill can lose them.
    progress_interval : float
        [s] after which the progress moves where nobody tells what share is done.
    peaks_only : bool
        Whether to keep peaks, folds and errors of each curve, and not its points.
    """

    batch: int = 10
    expected_harmonic: int = 9
    traced_share: float = 0.9
    max_rounds: int = 4
    save_interval: float = 1.0
    progress_interval: float = 1.0
    peaks_only: bool = False


SWEEP = SweepOptions()


class InterruptedOptions(Frozen):
    """What is calculated of a curve once it is interrupted, which is to take a second or so.

    Attributes
    ----------
    max_states : int
        Points times contacts: a curve with more is written with fewer points, and no more errors.
    min_points : int
        However many contacts there are.
    max_seconds_of_errors : float
        [s] that errors may take which are not known yet.
    """

    max_states: int = 20_000
    min_points: int = 200
    max_seconds_of_errors: float = 0.2

    def max_points(self, contacts: int) -> int:
        """Of a curve with so many contacts.

        >>> InterruptedOptions().max_points(25), InterruptedOptions().max_points(300)
        (800, 200)
        """
        return max(self.max_states // max(contacts, 1), self.min_points)


INTERRUPTED_CURVES = InterruptedOptions()


class SteppedOptions(Frozen):
    """How a sweep by steps of the frequency follows one motion.

    Attributes
    ----------
    max_distance : float
        Distance along the curve, in units of the motion, that is not continued at once.
    max_deviation : float
        Distance from what the direction foretells, relative to the way, beyond which a solution is on another
        branch;
    min_deviation : float
        but never within this distance, in units of the motion.
    min_step : float
        Part of the way between two frequencies that is not divided further: jumps are known to it.
    overshoot : float
        Part of that way, past the end of a branch, where the motion is simulated: nearer it would linger.
    irregular_step : float
        Part of the frequency by which a motion that repeats after no single period is taken at once,
    irregular_cycles : int
        and periods for which it is simulated after each leap.
    min_jump : float
        Relative change of an amplitude that is a jump.
    """

    max_distance: float = 0.5
    max_deviation: float = 0.6
    min_deviation: float = 0.05
    min_step: float = 1e-6
    overshoot: float = 0.1
    irregular_step: float = 0.005
    irregular_cycles: int = 10
    min_jump: float = 0.01


STEPPED = SteppedOptions()


class ExactOptions(Frozen):
    """How exact curves are calculated.

    Attributes
    ----------
    max_harmonic : int
        Harmonic up to which modes are kept as they are; what that does is measured.
    min_contacts : int
        Fewest of a scene of which some may be foreseen to keep their state.
    max_seconds : float, optional
        [s] of processor time for a curve; what there is of it then, is the result. None for no limit.
    stiff_seconds : float
        [s] of processor time for a curve that a stiff contact may keep from ever being finished.
    search_fraction : float
        Part of the time for a curve, that the search for what leads to further branches may take.
    peak_threshold : float
        Part of the greatest amplitude of a degree of freedom: lower peaks of the balance are not the highest.
    max_peak_error : float
        Relative error of peaks by one harmonic, beyond which one that is near enough has too many.
    """

    max_harmonic: int = 3
    min_contacts: int = 2
    max_seconds: float | None = None
    stiff_seconds: float = 10.0
    search_fraction: float = 0.5
    peak_threshold: float = 0.9
    max_peak_error: float = 0.1


EXACT_CURVES = ExactOptions()


class ResumableOptions(Frozen):
    """How often a curve is saved while it is followed.

    Attributes
    ----------
    save_interval : float
        [s] between two savings at least,
    time_fraction : float
        which may take this part of the time.
    poll_interval : float
        [s] between two looks at the processor time, which takes long to tell on some machines.
    """

    save_interval: float = 0.5
    time_fraction: float = 0.05
    poll_interval: float = 0.05


RESUMABLE = ResumableOptions()


class CoexistingOptions(Frozen):
    """Which motions at one frequency are the same.

    Attributes
    ----------
    orbit_tolerance : float
        Relative difference of two periodic motions, below which they are one.
    extent_tolerance : float
        Relative difference of amplitudes, up to which a motion is within an extent.
    amplitude_tolerance : float
        Relative range of amplitudes, below which they are the same.
    """

    orbit_tolerance: float = 1e-5
    extent_tolerance: float = 1e-3
    amplitude_tolerance: float = 1e-6


COEXISTING = CoexistingOptions()


class ContactChangeOptions(Frozen):
    """Which changes at a contact are rounding.

    Attributes
    ----------
    point_tolerance : float
        Distance, in the problem's scale, that rounding may put between the same point of two problems.
    """

    point_tolerance: float = 1e-8


CONTACT_CHANGES = ContactChangeOptions()


class FittedResponseOptions(Frozen):
    """How the response of a fit is traced.

    Attributes
    ----------
    max_rounds : int
        Of more harmonics, until the response takes no more than the fit had.
    misfit_share : float
        Of what the data are off, relative, that the response may err by.
    min_accuracy : float
        Relative, below which no more harmonics are taken for it.
    fit_share : float
        Share of the progress bar that is over when the numbers are found.
    """

    max_rounds: int = 3
    misfit_share: float = 0.1
    min_accuracy: float = 1e-5
    fit_share: float = 0.8


FITTED_RESPONSE = FittedResponseOptions()


class OptimumOptions(Frozen):
    """How the least peak is found, and the curves of peaks on which it is.

    Attributes
    ----------
    max_rounds : int
        Of choosing harmonics by the accuracy at the optimum.
    min_height : float
        Part of the greatest peak: those that are lower are none.
    search_share : float
        Share of the progress bar that is over when the optimum is found.
    frequency_tolerance : float
        Relative difference of frequencies at which a peak was tracked and traced.
    max_dofs : int
        Degrees of freedom, up to which a curve is followed by all: their peaks are points of it.
    nearly : float
        Share above the least peak, up to which it is reported for which numbers.
    search : SearchOptions
        How the least over a range of one number is found.
    """

    max_rounds: int = 4
    min_height: float = 1e-6
    search_share: float = 0.8
    frequency_tolerance: float = 1e-6
    max_dofs: int = 50
    nearly: float = 0.01
    search: SearchOptions = SEARCH


OPTIMUM = OptimumOptions()


class ResponseOptions(Frozen):
    """Tolerances and limits of a response, for `fcm.respond` and for what traces, follows and optimises.

    Attributes
    ----------
    balance : HarmonicBalanceOptions
        Of the balance, and what more harmonics may take.
    refinement : RefinementOptions
        How harmonics are added for an accuracy.
    optimum : OptimumOptions
        How the least peak is found.
    sweep : SweepOptions
        How the curves of a sweep are traced.
    interrupted : InterruptedOptions
        What is calculated of a curve once it is interrupted.
    reduction : ReductionOptions
        What curves do not need: modes that are replaced by static ones.
    exact : ExactOptions
        How exact curves are calculated,
    shooting : ShootingOptions
        and the periodic motions that they consist of.
    others : tuple
        Options of what is computed from a balance, each of the class of its package: `FoldOptions`,
        `LevelOptions`, `LevelCurveOptions` and `LevelReachOptions` of the branches, `ValidityOptions` and
        `StabilityOptions`.
    """

    balance: HarmonicBalanceOptions = HARMONIC_BALANCE
    refinement: RefinementOptions = REFINEMENT
    optimum: OptimumOptions = OPTIMUM
    sweep: SweepOptions = SWEEP
    interrupted: InterruptedOptions = INTERRUPTED_CURVES
    reduction: ReductionOptions = REDUCTION
    exact: ExactOptions = EXACT_CURVES
    shooting: ShootingOptions = SHOOTING
    others: tuple[object, ...] = ()


RESPONSE = ResponseOptions()


def leaving_out(tolerance: float | None, options: ResponseOptions = RESPONSE) -> ResponseOptions:
    """What changes the response by no more is left out; 0: what has no effect at all, None: nothing."""
    return replace(options, reduction=replace(options.reduction, tolerance=tolerance))
