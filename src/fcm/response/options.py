"""Tolerances and limits with which responses are calculated and reported."""

from __future__ import annotations

from dataclasses import replace

from fcm.accuracy.options import REFINEMENT, RefinementOptions
from fcm.frozen import Frozen
from fcm.harmonic_balance.options import HARMONIC_BALANCE, HarmonicBalanceOptions
from fcm.reduction.options import REDUCTION, ReductionOptions
from fcm.shooting.options import SHOOTING, ShootingOptions
from fcm.tracking.options import SEARCH, SearchOptions


class InputLimits(Frozen):
    """Limits of input: values beyond them are more likely a mistake than intended.

    Attributes
    ----------
    accuracy : float
        Default relative accuracy of peaks and folds.
    max_frequency_ratio : float
        Frequency relative to the highest natural frequency, beyond which it is refused as a mistake of units.
    max_level : float
        Level of the forces beyond which it is refused as a mistake of units.
    min_level : float
        Level of the forces below which the structure hardly moves: a span that ends below it is refused.
    max_amplitude_ratio : float
        Greatest ratio of the ends of a span of amplitudes; a greater one is refused.
    min_relative_width : float
        Relative width of a span below which it is refused: even the first steps would be mere rounding.
    """

    accuracy: float = 1e-2
    max_frequency_ratio: float = 1e6
    max_level: float = 1e6
    min_level: float = 1e-3
    max_amplitude_ratio: float = 1e15
    min_relative_width: float = 1e-6


INPUT_LIMITS = InputLimits()


class SentenceOptions(Frozen):
    """Options on what sentences to the user name and advise.

    Attributes
    ----------
    max_dofs, max_harmonics, max_frequencies : int
        Most degrees of freedom, harmonics and frequencies that one sentence names.
    few_harmonics : int
        Number of harmonics that is proposed as a faster alternative to those of the accuracy.
    low_peak : float
        Height of the peak with the greatest error, relative to the greatest peak, below which the sentence
        states this height.
    max_states : int
        Most letters of a sequence of contact states; a longer one, of a contact that chatters, is cut off.
    resonance_tolerance : float
        Relative distance of a harmonic's frequency from a resonance, up to which a curve is said to stop
        there.
    spring_ratio : float
        Ratio of that resonance to the frequency of the advised spring to the ground: the spring shifts the
        resonance by 1/1800.
    contacts_in_time : int
        Number of contacts above which the exact motion is not advised: a frequency takes minutes.
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
        Most rounds of more harmonics; after them the shortfall is reported.
    save_interval : float
        [s] Interval at which finished curves of an unfinished batch are saved, so that a kill loses none.
    progress_interval : float
        [s] Interval at which the progress advances where no share is reported.
    peaks_only : bool
        Whether to keep only peaks, folds and errors of each curve, without its points.
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
    """Options on what is still computed for a curve after an interruption, within about a second.

    Attributes
    ----------
    max_states : int
        Most points times contact directions of a curve with errors: a larger curve is written with fewer
        points, and without further errors.
    min_points : int
        Least number of points that are written, for any number of contacts.
    max_seconds_of_errors : float
        [s] Time that the missing errors may take; if they need more, they are left out.
    """

    max_states: int = 20_000
    min_points: int = 30
    max_seconds_of_errors: float = 0.2

    def max_points(self, directions: int) -> int:
        """Most points that are written of a curve whose contacts have this total number of directions.

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
        Step, relative to the interval between two frequencies, below which it is not divided: the resolution
        of jumps.
    overshoot : float
        Distance past the end of a branch, relative to the rest of the interval, at which the motion is
        simulated: closer to the end the transient would be very long.
    irregular_step : float
        Longest step, relative to the frequency, of a motion that is not periodic.
    irregular_cycles : int
        Number of periods for which such a motion is simulated after each step.
    min_jump : float
        Relative change of an amplitude above which it is a jump.
    max_change : float
        Relative change of an amplitude in a step of a motion of several periods, above which the step is
        divided.
    min_step_of_periods : float
        Step of such a motion, relative to the frequency, below which it is not divided: the resolution of its
        jumps.
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
        Highest harmonic of the response; only modes far above it are replaced by static ones. The effect of
        this is measured.
    min_contacts : int
        Least number of contacts of a scene for which some are predicted to keep their state.
    max_seconds : float, optional
        [s] Processor time of a curve, after which the part found so far is the result. None for no limit.
    stiff_seconds : float
        [s] This limit, if there is none, for a curve that a stiff contact may keep from ever ending.
    search_fraction : float
        Greatest time of the search for further branches, relative to the time limit of a curve.
    peak_threshold : float
        Height of a peak of the balance, relative to the greatest amplitude of its degree of freedom, below
        which it does not count as one of the highest.
    max_peak_error : float
        Relative error of the peaks with one harmonic, up to which they serve as guesses.
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
        Greatest share of the time that savings may take.
    poll_interval : float
        [s] Time between two readings of the processor time, which are slow on some machines.
    """

    save_interval: float = 0.5
    time_fraction: float = 0.05
    poll_interval: float = 0.05


RESUMABLE = ResumableOptions()


class CoexistingOptions(Frozen):
    """Options on which motions at one frequency count as the same.

    Attributes
    ----------
    orbit_tolerance : float
        Relative difference of two periodic motions below which they are the same.
    extent_tolerance : float
        Relative difference of amplitudes up to which a motion is within an extent.
    amplitude_tolerance : float
        Relative range of amplitudes up to which they count as equal.
    """

    orbit_tolerance: float = 1e-5
    extent_tolerance: float = 1e-3
    amplitude_tolerance: float = 1e-6


COEXISTING = CoexistingOptions()


class ContactChangeOptions(Frozen):
    """Options on which changes at a contact count as rounding.

    Attributes
    ----------
    point_tolerance : float
        Distance, in the problem's scale, up to which points of two problems count as the same.
    """

    point_tolerance: float = 1e-8


CONTACT_CHANGES = ContactChangeOptions()


class FittedResponseOptions(Frozen):
    """Options on how the response of a fit is traced.

    Attributes
    ----------
    max_rounds : int
        Most rounds of more harmonics, until the response needs no more than the fit had.
    misfit_share : float
        Error that the response may have, relative to the misfit of the data.
    min_accuracy : float
        Least value of the relative accuracy that this error asks for.
    fit_share : float
        Share of the progress bar for finding the numbers.
    """

    max_rounds: int = 3
    misfit_share: float = 0.1
    min_accuracy: float = 1e-5
    fit_share: float = 0.8


FITTED_RESPONSE = FittedResponseOptions()


class OptimumOptions(Frozen):
    """Options on the search for the least peak, and on the curves of peaks that contain it.

    Attributes
    ----------
    max_rounds : int
        Most rounds of choosing harmonics by the accuracy at the optimum.
    min_height : float
        Height, relative to the greatest peak, up to which a peak is ignored.
    search_share : float
        Share of the progress bar for finding the optimum.
    frequency_tolerance : float
        Relative difference of the frequencies of a tracked and a traced peak, up to which they are the same.
    max_dofs : int
        Number of degrees of freedom up to which a curve is followed by all of them, so that their peaks are
        points of it.
    nearly : float
        Relative height above the least peak, for which the range of the number is reported.
    min_unstable : float
        Part of the range of a number in which the greatest peak is unstable, above which that is reported.
    unstable_samples : int
        Number of values of it at which stability is looked up.
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
    """Tolerances and limits of a response, for `fcm.respond` and all other calculations of responses.

    Attributes
    ----------
    balance : HarmonicBalanceOptions
        Options of the harmonic balance, and limits of the work with more harmonics.
    refinement : RefinementOptions
        How harmonics are added for an accuracy.
    optimum : OptimumOptions
        How the least peak is found.
    sweep : SweepOptions
        How the curves of a sweep are traced.
    interrupted : InterruptedOptions
        What is calculated of a curve after an interruption.
    reduction : ReductionOptions
        Which modes are replaced by static ones.
    exact : ExactOptions
        How exact curves are calculated.
    shooting : ShootingOptions
        How the periodic motions of exact curves are calculated.
    others : tuple
        Options of computations with a balance, each of the class of its package: `FoldOptions`,
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
    """Options that leave out modes that change the response by no more than a tolerance.

    0 leaves out only what has no effect at all, None nothing.
    """
    return replace(options, reduction=replace(options.reduction, tolerance=tolerance))
