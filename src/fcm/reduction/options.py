"""Reduction: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ReductionOptions(Frozen):
    """Options on which modes are replaced by static ones, and how that is checked."""

    # part of its slip limit, or of its gap, that a contact has to keep so that it is foreseen to keep its
    # state
    load_margin: float = 0.3
    cycle_angles: int = 64  # number of angles of a cycle at which that is checked
    # frequency that a contact's springs give, relative to the highest mode, above which the contact is not
    # replaced: the digits of its force would be lost
    stiffness_ratio: float = 100.0
    # number of frequencies of the range at which linear responses are compared, besides resonances
    frequencies: int = 24
    # relative distance from a resonance at which the response is computed: there nothing is infinite
    resonance_offset: float = 1e-7
    max_curves: int = 8  # most curves of a sweep of which points are compared
    max_points: int = 4  # most points of each of them, those of its peaks first
    # largest relative change of the response by what is left out; 0: only what has no effect at all; None:
    # nothing
    tolerance: float | None = 1e-5
    rounding: float = 1e-14  # sum of products, relative to their sizes, up to which it is zero
    # most points of all curves at which the response is compared with that of all modes
    max_checked: int = 200
    max_checked_of_curve: int = 8  # most points of one curve for that, besides its peaks
    max_names: int = 6  # most contacts that one sentence names
    # share of the modes that may remain; with more nothing is gained, and nothing is replaced
    max_remaining: float = 0.6
    # share of the modes that may remain where combinations of many directions replace modes: more take as
    # long to check as they save
    max_remaining_of_many: float = 0.4
    min_modes: int = 30  # fewest modes of a structure for which it is tried
    # frequencies above which modes are replaced, relative to the range's end: the first that the tolerance
    # allows is taken
    range_factors: tuple[float, ...] = (2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0)
    # size of a static response, relative to the greatest, up to which it is a combination of the others
    rank_tolerance: float = 1e-10
    first_modes: int = 8  # number of combinations of many directions that are tried first
    added_modes: float = 1.5  # factor on that number after too few were tried
    # estimated change of the response, relative to the tolerance, below which modes are replaced
    estimate_margin: float = 0.5


REDUCTION = ReductionOptions()
