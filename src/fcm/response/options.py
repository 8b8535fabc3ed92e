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
    """Limits of what may be asked for: beyond them it is more likely a mistake than meant.

    Attributes
    ----------
    accuracy : float
        Relative accuracy of peaks and folds, where nothing else is asked for.
    max_frequency_ratio : float
        Frequency relative to the highest natural frequency, beyond which it is refused as a mistake of units.
    max_level : float
        Level of the forces beyond which it is refused as a mistake of units.
    min_level : float
        Level of the forces below which the structure does not move: a lower one is refused.
    max_amplitude_ratio : float
        Greatest ratio of the ends of a span of amplitudes; more is refused.
    min_relative_width : float
        Relative width of a span below which it is refused: not even the first steps would be more than
        rounding.
    """

    accuracy: float = 1e-2
    max_frequency_ratio: float = 1e6
    max_level: float = 1e6
    min_level: float = 1e-3
    max_amplitude_ratio: float = 1e15
    min_relative_width: float = 1e-6


INPUT_LIMITS = InputLimits()


class SentenceOptions(Frozen):
    """Options on how many things one sentence names.

    Attributes
    ----------
    max_dofs, max_harmonics, max_frequencies : int
        Most degrees of freedom, harmonics and frequencies that are named.
    few_harmonics : int
        Harmonics that are proposed beside those of the accuracy, where these take long and there are fewer.
    low_peak : float
        Height of the peak with the greatest error, relative to the greatest peak, below which it is said how
        low it is.
    max_states : int
        Most letters of a sequence of contact states: that of a contact which chatters has more, and is cut
        off.
    resonance_tolerance : float
        Relative distance of a harmonic's frequency from a resonance, up to which a curve is said to stop at
        it.
    spring_ratio : float
        Ratio of that resonance to the frequency of the spring to the ground that is advised: the spring
        shifts the resonance by 1/1800.
    contacts_in_time : int
        Number of contacts above which nobody is sent to the exact motion: a frequency takes minutes.
    """

    max_dofs: int = 3
    max_harmonics: int = 6
    max_frequencies: int = 5
    few_harmonics: int = 3
    low_peak: float = 0.1
    max_states: int = 60
    resonance_tolerance: float = 1e-5
    spring_ratio: float = 30.0
    contacts_in_time: int = 12


SENTENCES = SentenceOptions()


class SweepOptions(Frozen):
    """Options on how the curves of a sweep are traced.

    Attributes
    ----------
    batch : int
        Most curves that are finished or interrupted together.
    batch_seconds : float
        [s] Estimated time of the curves of a batch; one that takes longer is a batch of its own.
    expected_harmonic : int
        Highest harmonic that is expected, where an accuracy decides.
    traced_share : float
        Share of the progress bar for tracing the curves; the rest is for checking them.
    max_rounds : int
        Most rounds of more harmonics, after which what is lacking is said.
    save_interval : float
        [s] Time after which finished curves are saved before their batch is, so that no kill loses them.
    progress_interval : float
        [s] Time after which the progress moves where nobody tells what share is done.
    peaks_only : bool
        Whether to keep peaks, folds and errors of each curve, and not its points.
    """

    batch: int = 10
    batch_seconds: float = 1.0
    expected_harmonic: int = 9
    traced_share: float = 0.9
    max_rounds: int = 4
    save_interval: float = 1.0
    progress_interval: float = 1.0
    peaks_only: bool = False


SWEEP = SweepOptions()


class InterruptedOptions(Frozen):
    """Options on what is still computed of a curve after an interruption, in a second or so.

    Attributes
    ----------
    max_states : int
        Most points times directions of contacts of a curve with errors: a curve with more is written with
        fewer points, and no further errors.
    min_points : int
        Least number of points that are written, however many contacts there are.
    max_seconds_of_errors : float
        [s] Time that errors not known yet may take; with more they are left out.
    """

    max_states: int = 20_000
    min_points: int = 30
    max_seconds_of_errors: float = 0.2

    def max_points(self, directions: int) -> int:
        """Most points that are written of a curve whose contacts have so many directions in all.

        >>> InterruptedOptions().max_points(50), InterruptedOptions().max_points(900)
        (400, 30)
        """
        return max(self.max_states // max(directions, 1), self.min_points)


INTERRUPTED_CURVES = InterruptedOptions()


class SteppedOptions(Frozen):
    """Options on how a sweep by steps of the frequency follows one motion.

    Attributes
    ----------
    max_distance : float
        Distance along the curve, in units of the motion, above which a step is divided.
    max_deviation : float
        Distance of a solution from its prediction, relative to the step, above which it is on another branch.
    min_deviation : float
        Distance of a solution from its prediction, in units of the motion, up to which it is never on another
        branch.
    min_step : float
        Step relative to the way between two frequencies, below which it is not divided: jumps are known to
        it.
    overshoot : float
        Distance past the end of a branch, relative to the way that is left, at which the motion is simulated:
        nearer it would linger.
    irregular_step : float
        Longest step, relative to the frequency, of a motion that repeats after no number of periods.
    irregular_cycles : int
        Number of periods for which such a motion is simulated after each step.
    min_jump : float
        Relative change of an amplitude above which it is a jump.
    max_change : float
        Relative change of an amplitude in a step of a motion of several periods, above which the step is
        divided.
    min_step_of_periods : float
        Step of such a motion, relative to the frequency, below which it is not divided: its jumps are known
        to it.
    """

    max_distance: float = 0.5
    max_deviation: float = 0.6
    min_deviation: float = 0.05
    min_step: float = 1e-6
    overshoot: float = 0.1
    irregular_step: float = 0.005
    irregular_cycles: int = 10
    min_jump: float = 0.01
    max_change: float = 0.03
    min_step_of_periods: float = 1e-4


STEPPED = SteppedOptions()


class ExactOptions(Frozen):
    """Options on how exact curves are calculated.

    Attributes
    ----------
    max_harmonic : int
        Highest harmonic of the response that modes have to lie far above to be replaced by static ones; the
        effect of that is measured.
    min_contacts : int
        Least number of contacts of a scene of which some may be foreseen to keep their state.
    max_seconds : float, optional
        [s] Processor time of a curve, after which what there is of it is the result. None for no limit.
    stiff_seconds : float
        [s] The same limit for a curve that a stiff contact may keep from ever being finished.
    search_fraction : float
        Time of the search for further branches, relative to the time of a curve, at most.
    peak_threshold : float
        Height of a peak of the balance, relative to the greatest amplitude of its degree of freedom, below
        which it is not one of the highest.
    max_peak_error : float
        Relative error of the peaks with one harmonic, up to which they are near enough as guesses.
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
    """Options on how often a curve is saved while it is followed.

    Attributes
    ----------
    save_interval : float
        [s] Least time between two savings.
    time_fraction : float
        Time that savings may take, relative to all.
    poll_interval : float
        [s] Time between two readings of the processor time, which takes long to read on some machines.
    """

    save_interval: float = 0.5
    time_fraction: float = 0.05
    poll_interval: float = 0.05


RESUMABLE = ResumableOptions()


class CoexistingOptions(Frozen):
    """Options on which motions at one frequency are the same.

    Attributes
    ----------
    orbit_tolerance : float
        Relative difference of two periodic motions below which they are the same.
    extent_tolerance : float
        Relative difference of amplitudes up to which a motion is within an extent.
    amplitude_tolerance : float
        Relative range of amplitudes up to which they are the same.
    """

    orbit_tolerance: float = 1e-5
    extent_tolerance: float = 1e-3
    amplitude_tolerance: float = 1e-6


COEXISTING = CoexistingOptions()


class ContactChangeOptions(Frozen):
    """Options on which changes at a contact are rounding.

    Attributes
    ----------
    point_tolerance : float
        Distance in the problem's scale that rounding may put between the same point of two problems.
    """

    point_tolerance: float = 1e-8


CONTACT_CHANGES = ContactChangeOptions()


class FittedResponseOptions(Frozen):
    """Options on how the response of a fit is traced.

    Attributes
    ----------
    max_rounds : int
        Most rounds of more harmonics, until the response takes no more than the fit had.
    misfit_share : float
        Error that the response may have, relative to the misfit of the data.
    min_accuracy : float
        Relative accuracy beyond which no more harmonics are taken for it.
    fit_share : float
        Share of the progress bar for finding the numbers.
    """

    max_rounds: int = 3
    misfit_share: float = 0.1
    min_accuracy: float = 1e-5
    fit_share: float = 0.8


FITTED_RESPONSE = FittedResponseOptions()


class OptimumOptions(Frozen):
    """Options on how the least peak is found, and the curves of peaks on which it is.

    Attributes
    ----------
    max_rounds : int
        Most rounds of choosing harmonics by the accuracy at the optimum.
    min_height : float
        Height relative to the greatest peak, up to which a peak is ignored.
    search_share : float
        Share of the progress bar for finding the optimum.
    frequency_tolerance : float
        Relative difference of the frequencies of a tracked and a traced peak, up to which they are the same.
    max_dofs : int
        Number of degrees of freedom up to which all of them steer the steps of a curve, so that their peaks
        are points of it.
    nearly : float
        Relative height above the least peak, up to which it is reported for which numbers peaks are as low.
    min_unstable : float
        Part of the range of a number in which the greatest peak is unstable, above which that is reported.
    unstable_samples : int
        How many numbers that is looked at.
    search : SearchOptions
        Options of the search for the least peak over a range of one number.
    """

    max_rounds: int = 4
    min_height: float = 1e-6
    search_share: float = 0.8
    frequency_tolerance: float = 1e-6
    max_dofs: int = 50
    nearly: float = 0.01
    min_unstable: float = 0.05
    unstable_samples: int = 401
    search: SearchOptions = SEARCH


OPTIMUM = OptimumOptions()


class ResponseOptions(Frozen):
    """Tolerances and limits of a response, for `fcm.respond` and for what traces, follows and optimises.

    Attributes
    ----------
    balance : HarmonicBalanceOptions
        Options of the harmonic balance, and what more harmonics may take.
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
        How exact curves are calculated.
    shooting : ShootingOptions
        How the periodic motions are calculated of which exact curves consist.
    others : tuple
        Options of what is computed from a balance, each of the class of its package: `FoldOptions`,
        `BranchingOptions`, `LevelOptions`, `LevelCurveOptions` and `LevelReachOptions` of the branches,
        `ValidityOptions` and `StabilityOptions`.
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
    """Options that leave out whatever changes the response by no more than a tolerance.

    0: what has no effect at all, None: nothing.
    """
    return replace(options, reduction=replace(options.reduction, tolerance=tolerance))
