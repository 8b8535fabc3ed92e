"""Options of the reduction of scenes: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ReductionOptions(Frozen):
    """Options on the omission of contacts and the replacement of modes, and on the checks of both."""

    # least margin to its slip limit, or to its gap, of a contact that is expected to keep its state, relative
    # to the limit
    load_margin: float = 0.3
    cycle_angles: int = 64  # number of angles of a cycle at which the margin is checked
    # ratio of a contact's squared frequency to that of the highest mode, above which the contact is not
    # replaced by springs: the digits of its force would be lost
    stiffness_ratio: float = 100.0
    # number of frequencies of the range at which linear responses are compared, in addition to resonances
    frequencies: int = 24
    # relative distance from a resonance at which the response is computed, to avoid infinite values
    resonance_offset: float = 1e-7
    max_curves: int = 8  # most curves of a sweep on which points are compared
    max_points: int = 4  # most points of each of these curves, peaks first
    # largest relative change of the response by omissions; 0: omit only parts without any effect; None: omit
    # nothing
    tolerance: float | None = 1e-5
    rounding: float = 1e-14  # sum of products, relative to their sizes, up to which it is zero
    # most points of all curves at which the response is compared with that with all modes
    max_checked: int = 200
    max_checked_of_curve: int = 8  # most points of one curve for this check, besides its peaks
    max_names: int = 6  # most contacts that one sentence names
    # greatest share of the modes that may remain; with more nothing is saved, and nothing is replaced
    max_remaining: float = 0.6
    # the same share if combinations of many directions replace modes: checking more takes as long as they
    # save
    max_remaining_of_many: float = 0.4
    min_modes: int = 30  # least number of modes for a replacement
    # frequencies above which modes are replaced, relative to the end of the range; the first that meets the
    # tolerance is used
    range_factors: tuple[float, ...] = (2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 25.0)
    # size of a static response, relative to the greatest, up to which it depends linearly on the others
    rank_tolerance: float = 1e-10
    first_modes: int = 8  # first number of combinations of many directions
    added_modes: float = 1.5  # factor on this number as long as it is too small
    # estimated change of the response, relative to the tolerance, below which modes are replaced
    estimate_margin: float = 0.5


REDUCTION = ReductionOptions()
