r"""Harmonics that an accuracy requires, from the spectrum of the exact forces and the receptance.

The peaks and folds of a curve are displaced to its reference. There the share of each harmonic, without
feedback, is |G(h omega) F_h| relative to the amplitude. Together the missing harmonics change the motion more
than the sum of their shares, as they act on one another. The pair gives this gain:

    gain = change / sum of the shares of the reference's further harmonics

The shares are those of the motion of the structure where it counts. A harmonic may move the contacts alone,
as an even one on the two faces of a shroud does, and change the motion by their forces. The gain is then
large, and low harmonics are taken without gaps.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.accuracy.embedded_pair import Mask
from fcm.accuracy.options import PAIR, REFINEMENT, PairOptions, RefinementOptions
from fcm.accuracy.reference_harmonics import keep_for_next, prolongation_to, reference_harmonics
from fcm.accuracy.reference_pieces import distinct, lengths
from fcm.accuracy.unchecked_response import UncheckedResponse
from fcm.continuation import Mark, Path
from fcm.distinct_values import distinct_values
from fcm.frozen import Frozen
from fcm.harmonic_balance.prolongation import Prolongation
from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.model.scene import FloatArray, Scene
from fcm.scene.options import LIMITS


class RequiredHarmonics(Frozen):
    """The harmonics that a response lacks, judged by its reference.

    change: greatest known relative change of a peak or fold by the reference. is_known: whether it is known
    for all peaks. share (harmonic,): greatest share of each harmonic. reference: harmonics of the reference.
    """

    change: float
    is_known: bool
    share: FloatArray
    reference: tuple[int, ...]


class _SpecialPoint(Frozen):
    """A peak or fold, with the points of a path (tries) at which the reference is sought in turn.

    counts (1 + dof,) marks which of the frequency and the amplitudes count there.
    """

    path: Path
    amplitude: FloatArray
    tries: list[int]
    counts: npt.NDArray[np.bool_]


def dofs_of_interest(scene: Scene, height: FloatArray, options: RefinementOptions = REFINEMENT) -> Mask:
    """Mask (dof,) of the degrees of freedom whose greatest amplitudes (`height`) must reach the accuracy.

    These are those of `output` if the scene has it, else all in the results, without those that hardly move.
    """
    asked = np.array([scene.asks_for(dof) for dof in scene.modal.dofs])
    moves: Mask = height > options.min_amplitude * height[asked].max(initial=0.0)
    return asked & moves


def required_harmonics(
    found: UncheckedResponse, options: RefinementOptions = REFINEMENT, pair: PairOptions = PAIR
) -> RequiredHarmonics:
    """The change of a response by its reference, computed at its peaks and folds only."""
    system, amplitudes = found.system, [one.amplitude for one in found.quantities]
    height = np.max([one.max(axis=0) for one in amplitudes], axis=0)
    size = np.where(dofs_of_interest(system.scene, height, options), height, np.inf)
    places = list(_places(found.traced.branches.paths, amplitudes, size, options, pair))
    share = _greatest_shares(
        FurtherHarmonics(system), np.array([one.path.z[one.tries[0]] for one in places]), size
    )
    more = reference_harmonics(system.harmonics, share, system.layout.ports, pair)
    if not share.any() or more == system.harmonics:
        return RequiredHarmonics(0.0, True, share, system.harmonics)
    prolongation, motions, change, is_known = prolongation_to(system, more, pair), [], 0.0, True
    for place in places:
        values = _displaced(prolongation, place)
        if values is None:
            is_known &= bool(place.counts[0])
            continue
        motions.append(np.array(prolongation.newton.z))
        change = max(change, float((values / np.append(1.0, size))[place.counts].max(initial=0.0)))
    keep_for_next(prolongation, system, more, pair)
    if motions:
        finer = FurtherHarmonics(system.with_harmonics(more))
        of_reference = _greatest_shares(finer, np.array(motions), size, ())
        share = (
            of_reference if is_known else np.maximum(share, of_reference)
        )  # if a peak is missed, the curve's own spectrum counts, too
    return RequiredHarmonics(change, is_known, share, more)


def needed(
    required: RequiredHarmonics,
    harmonics: tuple[int, ...],
    accuracy: float,
    options: RefinementOptions = REFINEMENT,
) -> tuple[int, ...]:
    """The present harmonics with the largest missing ones added, as many as the accuracy needs.

    Where the shares explain little of the change, low harmonics are added without gaps.
    """
    share = required.share.copy()
    share[np.array(harmonics) - 1] = 0.0
    order = np.argsort(-share, kind="stable")
    left = share.sum() - np.cumsum(share[order])
    new = [h - 1 for h in required.reference if h not in harmonics and h <= LIMITS.harmonics]
    known = required.change > accuracy and bool(share[new].any())
    gain = required.change / share[new].sum() if known else 0.0
    explained = gain <= options.max_gain  # by the spectrum
    gain = max(gain, 1.0) if known and required.is_known and explained else options.feedback_factor
    count = 1 + int(np.count_nonzero(gain * left > options.safety * accuracy))
    count = min(
        count,
        max(options.max_first_added, options.max_growth * len(harmonics)),
        LIMITS.harmonics - len(harmonics),
    )
    chosen = {int(k) + 1 for k in order[:count] if share[k] > 0.0}
    complete = options.complete_harmonics
    if not explained:
        complete = min(max(options.max_growth * len(harmonics), complete), LIMITS.harmonics)
    low = range(1, complete + 1) if chosen else ()
    return tuple(sorted({*harmonics, *chosen, *low}))


def _places(
    paths: Sequence[Path],
    amplitudes: Sequence[FloatArray],
    height: FloatArray,
    options: RefinementOptions,
    pair: PairOptions,
) -> list[_SpecialPoint]:
    """The special points of all paths: tops nearly as high as height (dof,), and folds.

    The height is infinite for a degree of freedom that does not count. If tops lie close together, as those
    of many degrees of freedom do, the first stands for all.
    """
    found, dofs = [], len(height)
    for path, amplitude in zip(paths, amplitudes, strict=True):
        tops, most = amplitude.argmax(axis=0), amplitude.max(axis=0)
        rivals = most > options.rival_fraction * height
        every, place = distinct_values(tops[rivals]), lengths(path)
        alone = every[distinct(place[every], pair.peak_spacing * (place[-1] - place[0]))]
        stands_for = alone[np.searchsorted(alone, tops, "right") - 1] if alone.size else tops
        for top in alone.tolist():
            counts = np.append(False, rivals & (stands_for == top))
            steps = (0, *(way * step for step in options.peak_offsets for way in (-1, 1)))
            tries = [top + step for step in steps if 0 <= top + step < len(path.z)]
            found.append(_SpecialPoint(path, amplitude, tries, counts))
        folds = path.where(Mark.FOLD)
        for fold in folds[:: -(-len(folds) // options.max_folds) or 1].tolist():
            found.append(_SpecialPoint(path, amplitude, [fold], np.arange(1 + dofs) == 0))
    return found


def _displaced(prolongation: Prolongation, place: _SpecialPoint) -> FloatArray | None:
    """Changes (1 + dof,) of frequency (relative) and amplitudes to the reference at a point; or None."""
    for i in place.tries:
        if prolongation.find_normal(place.path.z[i], place.path.direction[i], True):
            found, omega = np.asarray(prolongation.found), place.path.parameter[i]
            off: FloatArray = np.abs(np.append(found[0] / omega - 1.0, found[1:] - place.amplitude[i]))
            return off
    return None


def _greatest_shares(
    further: FurtherHarmonics, z: FloatArray, size: FloatArray, known: tuple[int, ...] | None = None
) -> FloatArray:
    """Greatest share (harmonic,) of each harmonic, but the known ones, at motions z (place, unknown + 1)."""
    share: FloatArray = further.shares(z, np.tile(size, (len(z), 1)), known).max(axis=0, initial=0.0)
    return share[: LIMITS.harmonics]
