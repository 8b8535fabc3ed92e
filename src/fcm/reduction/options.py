"""Reduction: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ReductionOptions(Frozen):
    """Which modes are replaced by static ones, and how that is checked."""

    load_margin: float = 0.3  # of its limit, or of its gap, that a contact is foreseen to keep
    cycle_angles: int = 64  # of a cycle at which that is looked at
    # times the highest mode: a stiffer spring would lose digits that the contact's force keeps
    stiffness_ratio: float = 100.0
    # frequencies of the range at which linear responses are looked at, besides resonances
    frequencies: int = 24
    resonance_offset: float = 1e-7  # relative distance from a resonance, where nothing is infinite
    max_curves: int = 8  # of a sweep, of which points are looked at
    max_points: int = 4  # of a curve, those of its peaks first
    # relative change of the response by what is left out; 0: only what has no effect at all; None: nothing
    tolerance: float | None = 1e-5
    rounding: float = 1e-14  # relative: a sum of products this small is zero
    max_checked: int = 200  # points at which the response is compared with that of all modes
    max_checked_of_curve: int = 8  # points of one curve, besides its peaks
    max_names: int = 6  # of contacts in one sentence
    max_remaining: float = 0.6  # of the modes; otherwise nothing is gained
    # the same of combinations of many directions: more take as long to check as they save
    max_remaining_of_many: float = 0.4
    min_modes: int = 30  # modes of a structure for which it is worth trying
    # times the range's end: where modes begin to be far above, the first that the tolerance allows is taken
    range_factors: tuple[float, ...] = (2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0)
    # relative size below which a static response is a combination of the others
    rank_tolerance: float = 1e-10
    first_modes: int = 8  # combinations of many directions that are tried first
    added_modes: float = 1.5  # times as many after those that are too few
    estimate_margin: float = 0.5  # of the tolerance, for the estimate that decides


REDUCTION = ReductionOptions()
