"""Options of the embedded pair: a curve and its reference with more harmonics, which gives the error."""

from __future__ import annotations

import math
from dataclasses import field, replace
from functools import cached_property

from fcm.continuation.options import SIGN_CHANGE, EventOptions, FollowOptions, SignChangeOptions, StepOptions
from fcm.frozen import Frozen


class CurveDistanceOptions(Frozen):
    """Options on how differences of two curves are interpolated between their points.

    Attributes
    ----------
    coincident : float
        Distance of two points, relative to the length of the curve, below which they coincide.
    max_halvings : int
        Number of bisections that locate a value of the parameter between two points.
    parts : int
        Number of parts of the interval between two points; a curve's rise above its top is sought between
        these parts.
    """

    coincident: float = 1e-4
    max_halvings: int = 40
    parts: int = 8


CURVE_DISTANCE = CurveDistanceOptions()


class PairOptions(Frozen):
    """Options on how the reference of a curve is chosen, and how closely it is compared.

    Attributes
    ----------
    harmonics_factor, min_harmonic, max_added : int
        Number of harmonics of the reference relative to that of the curve; least value of its highest
        harmonic; and most harmonics that it has more than the curve.
    max_named : int
        Most further harmonics of the reference that are named, that is chosen by the spectrum of the exact
        forces.
    min_share : float
        Effect of a harmonic, relative to that of all harmonics left out, above which it is named.
    leading_share, min_resonant_share : float
        Effect of a harmonic that meets a mode at a point, relative to the greatest effect there, and relative
        to an amplitude: above both it is named.
    max_unknowns, min_added : int
        Most unknowns of the reference; and number of harmonics that it may have more than the curve in any
        case.
    point_interval : int
        Number of points between two whose displacements to the reference are found at first; more are found
        between them where they are needed.
    interpolation_tolerance : float
        Error of an interpolated displacement, relative to it, from which on more of them are found.
    negligible_displacement : float
        Relative displacement below which it is not resolved any further.
    max_steepness : float
        Greatest relative slope of an amplitude by the frequency; it replaces steeper ones.
    max_seconds : float
        [s] Most work (see `fcm.harmonic_balance.cost_model`) of following the reference where no point of it
        lies normal to the curve; and as much again for points that are not found.
    work_fraction, min_seconds : float
        Most work of following the reference, relative to that of the response itself; and [s] work that it
        may take in any case.
    long_fraction : float
        Work that replaces `max_seconds`, relative to that of the response, where that is more.
    max_seconds_elsewhere, work_fraction_elsewhere, min_seconds_elsewhere : float
        Limits of the work for the parts of the reference that lie elsewhere: most seconds, share of the
        response's work, and seconds allowed in any case.
    piece_fraction : float
        Work of following the reference one way before other ways are followed, relative to all work
        elsewhere.
    level_fraction : float
        Work of following the force level at one frequency, relative to the work left elsewhere times the
        fraction of points that are still unknown.
    interval_factor : int
        Ratio of `point_interval` to the next smaller interval, at which motions are tried as starts of the
        reference.
    probes, min_found : int, float
        Approximate number of points along a curve whose displacements are found first; and the fraction of
        them that has to be found, or else the reference is another curve.
    fewer_factors : tuple of int
        Values that replace `harmonics_factor` in turn if following the reference takes too long. It is
        estimated to take the evaluations of the curve, times the ratio of the numbers of harmonics.
    following, following_of_many, coarse_following : FollowOptions
        How the reference is followed: with few contacts; with many, most of whose corners are slight; and on
        other branches, where only the points at given frequencies matter.
    many_contacts : int
        Number of contacts from which on they are many.
    max_point_seconds : float
        [s] Most work of all searches for displacements, successful or not.
    span_margin : float
        Distance beyond a stretch up to which the reference is followed, relative to the width of the stretch.
    end_tries : int
        Number of points at an end of a stretch from which the reference is sought.
    end_tolerance : float
        Relative difference of amplitudes below which the reference has reached the other end of a stretch;
        and of amplitudes and frequency, below which a fold elsewhere is that of the curve.
    peak_spacing : float
        Distance of two tops or folds, relative to the length of the curve, within which one stands for the
        others.
    reference_error : float
        Error of the reference itself, relative to a displacement: no estimated error at a point is less.
    second_factor : int
        Number of harmonics of the second reference (the reference of the reference), relative to that of the
        reference. It is sought at peaks, and where the reference is not reliable.
    second_named : int
        Most further harmonics of the second reference that are named.
    max_second_unknowns : int
        Most unknowns of the second reference; with more there is none.
    feedback_factor : float
        Effect of harmonics, relative to that without feedback. Where this estimate for the harmonics that the
        reference lacks exceeds the estimated error, the reference's own error is computed.
    max_spectra, max_uncertain : int
        Most points of a curve at which the harmonics that the reference lacks are computed, and most at which
        its own error is.
    peak_offsets : tuple of int
        Numbers of points to either side of a top at which the reference is sought, in turn, if it is not
        found at the top.
    rival_fraction : float
        Height relative to the greatest amplitude, above which a top may become the greatest.
    residual_factor : float
        Highest harmonic that is computed beyond the reference, relative to the one that meets the highest
        mode.
    max_residual_harmonic, max_products : int
        Highest of these harmonics in any case, and most multiplications of modes for all of them.
    samples_per_period : int
        Number of samples for each period of the highest harmonic.
    newton_tolerance : float
        Length of the last Newton step, relative to the displacement; the error that is left is far less.
    max_kept : int
        Most balances that are kept for the next curve.
    batch : int
        Number of places that are compared with all points of a curve at a time.
    least_peak : float
        Height of a local maximum, relative to the greatest amplitude of its degree of freedom, from which on
        it is a peak.
    peak_neighbours : int
        Number of points to either side of the highest one that are computed if their interpolated heights are
        above it.
    rounding : float
        Difference of a force, slip or energy of a contact, relative to its greatest, up to which it is
        ignored.
    distance : CurveDistanceOptions
        How differences are interpolated between points of a curve.
    """

    harmonics_factor: int = 4
    min_harmonic: int = 5
    max_added: int = 15
    max_named: int = 4
    min_share: float = 0.02
    leading_share: float = 0.5
    min_resonant_share: float = 1e-3
    max_unknowns: int = 240
    min_added: int = 3
    point_interval: int = 16
    interpolation_tolerance: float = 0.2
    negligible_displacement: float = 3e-5
    max_steepness: float = 100.0
    max_seconds: float = 2.0
    max_point_seconds: float = math.inf
    work_fraction: float = 0.3
    min_seconds: float = 0.4
    long_fraction: float = 0.0
    max_seconds_elsewhere: float = 8.0
    work_fraction_elsewhere: float = 1.6
    min_seconds_elsewhere: float = 0.8
    piece_fraction: float = 0.0625
    level_fraction: float = 0.25
    interval_factor: int = 4
    probes: int = 24
    min_found: float = 0.5
    fewer_factors: tuple[int, ...] = (3, 2)
    following: FollowOptions = field(
        default_factory=lambda: FollowOptions(0.1, events=EventOptions(peak_tolerance_of_many=1e-5))
    )
    following_of_many: FollowOptions = field(
        default_factory=lambda: FollowOptions(
            0.2,
            step=StepOptions(target_turn=0.4, target_miss=0.1, target_output_error=0.5, min_cosine=0.8),
            events=EventOptions(peak_tolerance_of_many=1e-5),
        )
    )
    many_contacts: int = 12
    coarse_following: FollowOptions = field(
        default_factory=lambda: FollowOptions(
            0.2,
            user_points_only=True,
            step=StepOptions(target_turn=0.4, target_miss=0.1, target_output_error=0.5, min_cosine=0.8),
            events=EventOptions(peak_threshold=math.inf),
        )
    )
    span_margin: float = 1.0
    end_tries: int = 8
    end_tolerance: float = 0.02
    peak_spacing: float = 0.005
    reference_error: float = 0.05
    second_factor: int = 2
    second_named: int = 8
    max_second_unknowns: int = 480
    feedback_factor: float = 3.0
    max_spectra: int = 16
    max_uncertain: int = 4
    peak_offsets: tuple[int, ...] = (1, 2, 4, 8)
    rival_fraction: float = 0.8
    residual_factor: float = 1.5
    max_residual_harmonic: int = 1024
    max_products: int = 10_000_000
    samples_per_period: int = 8
    newton_tolerance: float = 0.01
    max_kept: int = 24
    batch: int = 256
    least_peak: float = 1e-3
    peak_neighbours: int = 8
    rounding: float = 1e-9
    distance: CurveDistanceOptions = CURVE_DISTANCE

    @cached_property
    def second_pair(self) -> PairOptions:
        """Options for choosing the second reference, with still more harmonics."""
        return replace(
            self,
            harmonics_factor=self.second_factor,
            max_named=self.second_named,
            max_unknowns=self.max_second_unknowns,
        )


PAIR = PairOptions()
# for given harmonics: the pair estimates errors only, and nothing is traced again
OF_GIVEN = PairOptions(work_fraction=2.0, max_seconds=8.0, long_fraction=1.0, work_fraction_elsewhere=2.0)
# at single points, where many harmonics are cheap: as many as the second reference has
AT_POINTS = PairOptions(
    harmonics_factor=PAIR.harmonics_factor * PAIR.second_factor,
    min_harmonic=PAIR.min_harmonic * PAIR.second_factor,
    max_named=PAIR.second_named,
)


class RefinementOptions(Frozen):
    """Options on how harmonics are added to a curve until its pair agrees.

    Attributes
    ----------
    max_rounds : int
        Most rounds of tracing, estimating the error and choosing harmonics.
    safety : float
        Target for the effect of the harmonics left out, relative to the accuracy.
    feedback_factor : float
        Effect of harmonics, relative to that without feedback, as long as the pair does not give it.
    max_gain : float
        Effect of harmonics by the pair, relative to that without feedback, above which the spectrum does not
        explain it: they act by the motion of contacts. Low harmonics are then taken without gaps.
    max_first_added, max_growth : int
        Most harmonics that are added at once, as a number, and relative to the present number; the larger
        limit holds.
    rival_fraction : float
        Height of a branch's top, relative to the greatest amplitude, above which it is checked.
    min_amplitude : float
        Amplitude of a degree of freedom, relative to the greatest, up to which no accuracy is required.
    peak_offsets : tuple of int
        Numbers of points to either side of a top at which the reference is sought, in turn, if it is not
        found at the top.
    max_folds : int
        Most folds of a branch that are checked.
    complete_harmonics : int
        Harmonic up to which no single one is left out: stability between folds may depend on it.
    max_seconds_without_progress : float
        [s] Most work of rounds that are not known to bring the accuracy nearer.
    """

    max_rounds: int = 8
    safety: float = 0.4
    feedback_factor: float = 3.0
    max_gain: float = 10.0
    max_first_added: int = 6
    max_growth: int = 2
    rival_fraction: float = 0.8
    min_amplitude: float = 1e-4
    peak_offsets: tuple[int, ...] = (1, 2, 4, 8)
    max_folds: int = 24
    complete_harmonics: int = 3
    max_seconds_without_progress: float = 3.0


REFINEMENT = RefinementOptions()


class ValidityOptions(Frozen):
    """Limits of the error up to which the stability of solutions is known.

    Attributes
    ----------
    max_error : float
        Estimated relative error of the amplitudes above which a solution is not called stable.
    max_fold_error : float
        Width of a stretch of stable solutions without a known error beside a fold, relative to their
        frequency, above which their stability is unknown.
    max_unknown_points : int
        Number of consecutive points without a reference, above which more harmonics do not have the branch.
    max_change : float
        Change of a solution, relative to its greatest displacement, above which it is taken for one on
        another branch.
    """

    max_error: float = 0.05
    max_fold_error: float = 1e-2
    max_unknown_points: int = 64
    max_change: float = 0.5


VALIDITY = ValidityOptions()


class StabilityLimitOptions(Frozen):
    """Options on how the stability limits of more harmonics are found beside those of fewer.

    Attributes
    ----------
    max_distance : float
        Number of points to either side of a crossing up to which that of more harmonics is sought.
    first_distance : float
        Distance at which it is sought first, in points; it is then doubled.
    tolerance : float
        Error of its place, relative to the interval between two points, at which the search ends.
    relative_tolerance : float
        Change of its frequency in a step, relative to its distance from the crossing of fewer harmonics, at
        which the search ends.
    max_evaluations : int
        Most solutions that are computed for it.
    min_growth : float
        Logarithm of the growth over a period that stands for any smaller one.
    crossing_distance : float
        Distance of the crossing of more harmonics from that of fewer, relative to the distance of any other,
        below which they belong together.
    sign_change : SignChangeOptions
        How the crossing is bracketed.
    """

    max_distance: float = 32.0
    first_distance: float = 0.5
    tolerance: float = 1e-5
    relative_tolerance: float = 0.03
    max_evaluations: int = 40
    min_growth: float = -0.3
    crossing_distance: float = 0.1
    sign_change: SignChangeOptions = SIGN_CHANGE


STABILITY_LIMITS = StabilityLimitOptions()
