"""A response with all branches and their stability, and the harmonics that an accuracy needs for all of it.

The traced response passes three stages: its branches, the events on them, and the degrees of freedom by which
it was not followed. Each stage returns the harmonics that it needs. If these are more, all is traced again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field, replace

import numpy as np
import numpy.typing as npt

from fcm.accuracy.further_levels import with_levels_below_peaks, with_levels_where_unstable, with_traced
from fcm.accuracy.options import VALIDITY
from fcm.accuracy.refinement import OnTraced, RefinedResponse, enlarged, retrace
from fcm.accuracy.stability_limits import StabilityLimit, distances_from, stability_limits
from fcm.accuracy.stability_validity import on_other_branch, without_neighbour
from fcm.branches.search import with_further_branches
from fcm.branches.symmetry_loss import symmetry_loss
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.model.scene import FloatArray, Scene
from fcm.response.master_dofs import with_all_dofs
from fcm.response.options import SWEEP
from fcm.stability.bifurcations import stability, with_points
from fcm.stability.options import STABILITY

IntArray = npt.NDArray[np.intp]
Harmonics = tuple[int, ...]


class Refined(Frozen):
    """A response, its events, and whether each of its points is stable.

    Attributes
    ----------
    found : RefinedResponse
        The response at the degrees of freedom by which it was followed.
    stable : list of array (point,)
        For each path; 1 stable, 0 unstable, NaN unknown.
    lost : list of StabilityLimit
        Frequencies at which stability changes without a fold, with their errors, where harmonics are chosen.
    exceeded : bool
        Whether more harmonics have a higher branch, where the harmonics are given.
    bifurcations : list of (str, float)
        Kinds and frequencies [rad/s] of changes of stability without a fold.
    every : RefinedResponse
        The response of all degrees of freedom.
    """

    found: RefinedResponse
    stable: list[FloatArray] = field(default_factory=list)
    lost: list[StabilityLimit] = field(default_factory=list)
    exceeded: bool = False
    bifurcations: list[tuple[str, float]] = field(default_factory=list)
    every: RefinedResponse | None = None


OnClassified = Callable[[RefinedResponse, list[FloatArray]], None]  # receives a response with its stability
# Arguments: the response, the previous one with fewer harmonics, the accuracy (None: harmonics are given),
# and the scene with all degrees of freedom. Results: the completed response, and the harmonics that it needs.
Stage = Callable[[Refined, Refined | None, float | None, Scene], tuple[Refined, Harmonics]]


def refined(
    found: RefinedResponse,
    accuracy: float | None,
    scene: Scene,
    on_traced: OnTraced,
    on_classified: OnClassified,
) -> Refined:
    """Complete a traced response with all branches, their events, and all degrees of freedom of a scene.

    With an accuracy it has the harmonics that these need, unless tracing with them takes too long. on_traced
    receives each response before more is traced, on_classified each one with its stability.
    """
    now, before = Refined(found), None
    stages: Sequence[Stage] = (_with_branches, _with_events, _with_all_dofs)
    for left in reversed(range(SWEEP.max_rounds + 1)):
        again = None
        for stage in stages:
            now, more = stage(now, before, accuracy, scene)
            if accuracy is not None and left and more != now.found.system.harmonics:
                on_traced(now.found, now.found.max_error, more)
                again = retrace(now.found, more, accuracy)
                if again is not None:
                    break
            if len(now.stable) == len(now.found.quantities):
                on_classified(now.found, now.stable)
        if again is None:
            break
        on_traced(again, again.max_error, ())
        now, before = Refined(again), now
    return now


def _with_branches(
    now: Refined, _: Refined | None, accuracy: float | None, __: Scene
) -> tuple[Refined, Harmonics]:
    """Add branches found from levels below the peaks, from folds and from branch points."""
    known, most = now.found.traced, _most(accuracy)
    found = with_levels_below_peaks(now.found, most)
    traced = with_further_branches(found.system, found.traced, isolated=not _is_of_these_alone(found))
    found = found if traced is found.traced else with_traced(found, traced, most)
    lost = symmetry_loss(found.system, found.traced)
    if lost.harmonics:
        found = replace(found, traced=replace(found.traced, symmetry_lost=lost.frequencies))
        return replace(now, found=found), tuple(sorted({*found.system.harmonics, *lost.harmonics}))
    is_new = len(traced.branches.paths) > len(known.branches.paths)
    more = enlarged(found, most) if is_new and not found.agrees else found.system.harmonics
    return replace(now, found=found), more


def _is_of_these_alone(found: RefinedResponse) -> bool:
    """Whether the response misses its accuracy for want of time, and some points have no near neighbour.

    The neighbour is the solution with more harmonics. Folds of the level of such a response need not exist
    with more harmonics either.
    """
    options, short = found.system.option(VALIDITY), bool(found.further) and not found.reached
    each = (without_neighbour(one.truncation, one.is_same_curve, options).any() for one in found.errors)
    return short and any(each)


def _with_events(
    now: Refined, before: Refined | None, accuracy: float | None, _: Scene
) -> tuple[Refined, Harmonics]:
    """Add stability and its changes, and branches found from levels where nothing is stable."""
    now = _with_stability(now, accuracy)
    found, exceeded = with_levels_where_unstable(now.found, now.stable, _most(accuracy))
    now = _with_stability(replace(now, found=found, exceeded=exceeded), accuracy)
    if before is not None:
        now = replace(now, lost=distances_from(now.lost, before.lost))
    off = (one for one in now.lost if not one.error <= _most(accuracy))
    more = {h for one in off for h in one.harmonics} | set(now.found.system.harmonics)
    return now, tuple(sorted(more))


def _with_all_dofs(
    now: Refined, _: Refined | None, accuracy: float | None, scene: Scene
) -> tuple[Refined, Harmonics]:
    """Add all degrees of freedom of a scene, if the response was followed by master ones."""
    found, most = now.found, _most(accuracy)
    if found.system.scene is scene:
        return replace(now, every=found), found.system.harmonics
    every = with_all_dofs(found, scene, most)
    short = found.reached and not every.reached
    return replace(now, every=every), enlarged(every, most) if short else found.system.harmonics


def _most(accuracy: float | None) -> float:
    return np.inf if accuracy is None else accuracy


def _with_stability(now: Refined, accuracy: float | None) -> Refined:
    """Add the stability of branches where it is unknown, and points where it changes between folds.

    With an accuracy the changes get their distance from those with more harmonics. A curve that misses the
    accuracy does not: it is reported as such, and its points far from the solution with more harmonics are
    not examined.
    """
    found, stable, lost = now.found, list(now.stable), list(now.lost)
    bifurcations, options = list(now.bifurcations), now.found.system.option(VALIDITY)
    short, known = accuracy is not None and not found.reached, len(stable)
    every = found.traced.branches.paths
    if known == len(every):
        return now
    found.system.work.tell("its stability")
    paths, quantities, errors = (
        list(every[:known]),
        list(found.quantities[:known]),
        list(found.errors[:known]),
    )
    for path, seen, error in zip(every[known:], found.quantities[known:], found.errors[known:], strict=True):
        beyond = on_other_branch(error.on_same_branch, options) if short else None
        unmatched = without_neighbour(error.truncation, error.is_same_curve, options)
        to_confirm = error.on_same_branch > options.max_error
        along = stability(found.system, path, beyond, found.system.option(STABILITY), unmatched, to_confirm)
        inserted = along.inserted
        bifurcations += [(one.kind.value, one.frequency) for one in along.crossings]
        if accuracy is not None and not short:
            lost += stability_limits(found.system, path, along.crossings, accuracy)
        if not inserted:
            paths.append(path)
            quantities.append(seen)
            errors.append(error)
            stable.append(along.stable)
            continue
        after = np.array([one.after for one in inserted], dtype=np.intp)
        paths.append(with_points(path, inserted))
        z, direction = (np.array([getattr(one, name) for one in inserted]) for name in ("z", "direction"))
        quantities.append(seen.with_rows(after, reported_at(found.system, z, direction)))
        errors.append(
            replace(
                error,
                amplitude=_between(error.amplitude, after),
                at_frequency=_between(error.at_frequency, after),
                truncation=_between(error.truncation, after),
                is_same_curve=np.insert(error.is_same_curve, after + 1, error.is_same_curve[after]),
                ends_before=np.insert(error.ends_before, after + 1, error.ends_before[after]),
                contact_loads=_between(error.contact_loads, after),
                contacts=error.contacts.with_rows(after, ContactRecord.at(found.system, z)),
            )
        )
        stable.append(np.insert(along.stable, after + 1, [one.stable for one in inserted]))
    branches = replace(found.traced.branches, paths=tuple(paths))
    traced = replace(found.traced, branches=branches)
    found = replace(found, traced=traced, quantities=tuple(quantities), errors=tuple(errors))
    return replace(now, found=found, stable=stable, lost=lost, bifurcations=bifurcations)


def _between(values: FloatArray, after: IntArray) -> FloatArray:
    """Insert, after some rows, the mean of the row and the next."""
    means = 0.5 * (values[after] + values[np.minimum(after + 1, len(values) - 1)])
    return np.insert(values, after + 1, means, axis=0)
