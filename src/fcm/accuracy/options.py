"""What the embedded pair is calculated with."""

from __future__ import annotations

import math
from dataclasses import field, replace
from functools import cached_property

from fcm.continuation.options import (
    SIGN_CHANGE,
    EventOptions,
    FollowOptions,
    SignChangeOptions,
    StepOptions,
)
from fcm.frozen import Frozen


class CurveDistanceOptions(Frozen):
    """How differences of two curves are interpolated between their points.

    Attributes
    ----------
    coincident : float
        Part of the length of a curve: points nearer to one another coincide.
    max_halvings : int
        Of a piece, to where its parameter is a value.
    parts : int
        Of the way from a point to the next, at which a curve may be higher than its top.
    """

    coincident: float = 1e-4
    max_halvings: int = 40
    parts: int = 8


CURVE_DISTANCE = CurveDistanceOptions()


class PairOptions(Frozen):
    """How the reference of a curve is chosen, and how closely it is looked at.

    Attributes
    ----------
    harmonics_factor, min_harmonic, max_added : int
        The reference has the harmonics up to so many times the number of those of the curve, and up to
        the least, but no more than the most beyond that number.
    max_named : int
        So many more that the spectrum of the exact forces names,
    min_share : float
        each with at least this part of what all that are left out would do.
    leading_share, min_resonant_share : float
        Part of the greatest share at a point, and of an amplitude, from which on a harmonic that meets a mode
        there is named.
    max_unknowns, min_added : int
        No more unknowns than this, but so many harmonics more than the curve in any case.
    point_interval : int
        Points of the curve from one that is displaced to the next, before it is known how they change.
    interpolation_tolerance : float
        Part of a displacement, by which it may be off where it is interpolated.
    negligible_displacement : float
        A displacement, relative, that is too small to be looked at more closely.
    max_steepness : float
        Relative change of an amplitude over that of the frequency, up to which both count.
    max_seconds : float
        Of work, as of `fcm.harmonic_balance.cost_model`, that following the reference may take where no
        point of it lies normal to the curve; as much again for points that are not found;
    work_fraction, min_seconds : float
        but no more than this part of the work that the response itself took, or so many seconds;
    long_fraction : float
        and, where that took long, this part of it.
    max_seconds_elsewhere, work_fraction_elsewhere, min_seconds_elsewhere : float
        The same of what the reference has elsewhere.
    piece_fraction : float
        Part of that, that following the reference one way may take before others are followed,
    level_fraction : float
        and part of what is left of it, that the level of the forces may take at one frequency, times
        the part of the points of which nothing is known yet.
    interval_factor : int
        `point_interval` over the next one, at which motions are tried that may lead to the reference.
    probes, min_found : int, float
        About so many points along a curve are displaced first. Where less than this part of them is found,
        the reference is another curve.
    fewer_factors : tuple of int
        `harmonics_factor` where following it takes longer than it may: about as many evaluations as the curve
        did, for so many times as many harmonics. The first with which it does not is taken.
    following, following_of_many, coarse_following : FollowOptions
        How the reference is followed; that of many contacts, most of whose corners are slight; and what it
        has elsewhere, of which only the passings of frequencies matter.
    many_contacts : int
        Contacts that are many.
    max_point_seconds : float
        The same that all points may take that are moved to the reference, those that are found too.
    span_margin : float
        Times the width of a stretch, how far beyond it the reference is followed.
    end_tries : int
        Points at an end of a stretch, from which the reference is sought.
    end_tolerance : float
        Relative difference of amplitudes up to which the reference has come to the other end of a stretch; of
        amplitudes and frequency, up to which a fold elsewhere is that of the curve.
    peak_spacing : float
        Part of the length of a curve: of the greatest amplitudes of degrees of freedom that lie so closely
        together one shows for all what the harmonics do that are left out, and of tops and folds which.
    reference_error : float
        Part of a displacement, by which the reference itself is off: no estimated error at a point is less.
    second_factor : int
        Times the reference's harmonics those of its own reference are, which is looked for at peaks and where
        the reference is not to be believed,
    second_named : int
        with so many more that the spectrum names,
    max_second_unknowns : int
        and with no more unknowns than this,
    feedback_factor : float
        Times what harmonics do without feedback, what they do: where that of those that the reference lacks
        is more than the error that it gives, what it is off by itself is looked for,
    max_spectra, max_uncertain : int
        at so many points of a curve at most, of so many at which the harmonics that it lacks are known.
    peak_offsets : tuple of int
        Points to either side of a top where it is looked for, too, if it is not at the top.
    rival_fraction : float
        Part of the greatest amplitude: what is this high may become the greatest.
    residual_factor : float
        Times the harmonic that meets the highest mode, up to which is looked at what the reference lacks,
    max_residual_harmonic, max_products : int
        the last that is looked at, and the multiplications of modes that this may take.
    samples_per_period : int
        Of the period of the highest harmonic.
    newton_tolerance : float
        Part of a displacement: when a step of Newton's method was less than this, what is left is far less.
    max_kept : int
        Balances that are kept for the next curve.
    batch : int
        Places that are compared with all points of a curve.
    least_peak : float
        Part of the greatest amplitude of a degree of freedom, from which on a local maximum is a peak.
    peak_neighbours : int
        Points to either side of the highest that may be higher where they are only interpolated.
    rounding : float
        Part of the greatest of a force, slip or energy of a contact: differences of this are nothing.
    distance : CurveDistanceOptions
        Between points of a curve.
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
        """Of the reference's own reference."""
        return replace(
            self,
            harmonics_factor=self.second_factor,
            max_named=self.second_named,
            max_unknowns=self.max_second_unknowns,
        )


PAIR = PairOptions()
# of harmonics that are given: the pair is for the errors alone, and nothing is traced again
OF_GIVEN = PairOptions(work_fraction=2.0, max_seconds=8.0, long_fraction=1.0, work_fraction_elsewhere=2.0)
# at single points, where many harmonics take little: as many as the reference of a reference has
AT_POINTS = PairOptions(
    harmonics_factor=PAIR.harmonics_factor * PAIR.second_factor,
    min_harmonic=PAIR.min_harmonic * PAIR.second_factor,
    max_named=PAIR.second_named,
)


class RefinementOptions(Frozen):
    """How harmonics are added to a curve until its pair agrees.

    Attributes
    ----------
    max_rounds : int
        Of tracing, estimating, choosing.
    safety : float
        Part of the accuracy, to which what is left out is chosen to come.
    feedback_factor : float
        Times what harmonics do without feedback, what they do, as long as the pair does not tell.
    max_first_added, max_growth : int
        Harmonics that are added at most to one, and times as many as there are to more.
    rival_fraction : float
        Part of the greatest amplitude, from which on a top of a branch is looked at.
    min_amplitude : float
        Part of the greatest amplitude: of degrees of freedom that move less no accuracy is asked.
    peak_offsets : tuple of int
        Points to either side of a top, where the reference may be found if it is not at the top.
    max_folds : int
        Folds of a branch that are looked at, at most.
    complete_harmonics : int
        Harmonic up to which no single one is left out: stability between folds may hang on it.
    max_seconds_without_progress : float
        [s] that rounds may take of which nothing shows that they bring the accuracy nearer.
    """

    max_rounds: int = 8
    safety: float = 0.4
    feedback_factor: float = 3.0
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
    """Up to which errors the stability of solutions is known.

    Attributes
    ----------
    max_error : float
        Estimated relative error of the amplitudes, up to which a solution is called stable.
    max_fold_error : float
        Part of its frequency, by which a fold may be moved where nothing is said of the accuracy.
    max_unknown_points : int
        Points in a row without a reference, after which a branch is not one of more harmonics.
    max_change : float
        Part of the greatest displacement: a change by more is not believed, as another branch may be there.
    """

    max_error: float = 0.05
    max_fold_error: float = 1e-2
    max_unknown_points: int = 64
    max_change: float = 0.5


VALIDITY = ValidityOptions()


class StabilityLimitOptions(Frozen):
    """How the limits of stability of more harmonics are found beside those of fewer.

    Attributes
    ----------
    max_distance : float
        Points to either side up to which the crossing of more harmonics is sought,
    first_distance : float
        from these on.
    tolerance : float
        Part of the way between two points, to which it is found: an error is known to a few parts of itself,
    relative_tolerance : float
        or to this part of itself, and of what it may be,
    max_evaluations : int
        with so many looks at most.
    min_growth : float
        Growth over a period, logarithmic, that is as good as any that is less.
    crossing_distance : float
        Part of the way to any other crossing, within which that of more harmonics is that of fewer.
    sign_change : SignChangeOptions
        How it is bracketed.
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
