r"""Error of a harmonic-balance curve, estimated by its embedded pair: curve and reference.

As with an embedded pair of Runge-Kutta formulas, the difference of both is the error of the lower one,

    e = |a_reference - a| / a

at the same frequency. The error of a peak is the difference of the heights, that of a fold the difference of
the frequencies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from fcm.accuracy.budget import Budget
from fcm.accuracy.contact_load_errors import contact_load_errors, relative
from fcm.accuracy.options import PAIR, PairOptions
from fcm.accuracy.peak_errors import PeakErrors, peak_errors
from fcm.accuracy.peaks import rise_between_points, tops_of_reference
from fcm.accuracy.reference_branches import affordable_reference, further_reference_pieces
from fcm.accuracy.reference_curve import Indices, ReferenceCurve
from fcm.accuracy.reference_errors import with_reference_errors
from fcm.accuracy.reference_harmonics import reference_harmonics
from fcm.accuracy.reference_pieces import CurvePiece, ReportedPath, distinct, lengths, nearest, piece_of
from fcm.continuation import Mark, Path
from fcm.distinct_values import distinct_values
from fcm.frozen import Frozen
from fcm.harmonic_balance.contact_cycles import ContactRecord
from fcm.harmonic_balance.reported_quantities import ReportedQuantities, reported_quantities
from fcm.harmonic_balance.residual_spectrum import FurtherHarmonics
from fcm.harmonic_balance.system import System
from fcm.model.scene import FloatArray
from fcm.scene.options import LIMITS
from fcm.stability.known_motions import KnownMotions

Mask = npt.NDArray[np.bool_]


class PathErrors(Frozen):
    """Relative errors of a path, estimated by the embedded pair; NaN where the pair gives no error.

    amplitude (point, dof): difference of the reference, at a peak in height, elsewhere at the same frequency.
    at_frequency (point, dof): difference at the same frequency, at peaks, too.
    truncation (point,): the greatest difference of an amplitude over the greatest amplitude.
    is_same_curve (point,): whether the reference's own branch comes to that frequency. Where it does not, as
    beside a fold that it has elsewhere, errors are the distance to the nearest motion of the reference there.
    ends_before (point,): where the reference turns back earlier, and has fewer motions of the branch.
    peak (dof,): error of the height of the greatest amplitude.
    peak_frequency (dof,): error of the frequency of that peak.
    height (dof,): the greatest amplitude of the reference, as an amplitude.
    fold (fold,): errors of the frequencies of the folds, in their order.
    share (harmonic,): shares of the harmonics left out, from harmonic 1 to the highest that can be asked for.
    A share is the harmonic's amplitude without feedback, at peaks and folds, over the greatest amplitude of
    the degree of freedom to which it matters most.
    reference: the harmonics with which the reference is followed elsewhere.
    contact_loads (point, contact, 4): errors of the contact loads, see `contact_cycles.cycles`, each relative
    to itself; infinite where it is 0, but not in the reference.
    greatest (contact, 4): errors of their maxima along the path.
    contacts: states and loads of the contacts of the path itself.
    pieces: the known pieces of the reference's curve.
    motions: the motions of the reference that were found.
    """

    amplitude: FloatArray
    at_frequency: FloatArray
    truncation: FloatArray
    is_same_curve: Mask
    ends_before: Mask
    peak: FloatArray
    peak_frequency: FloatArray
    height: FloatArray
    fold: FloatArray
    share: FloatArray
    reference: tuple[int, ...]
    contact_loads: FloatArray
    greatest: FloatArray
    contacts: ContactRecord
    pieces: tuple[CurvePiece, ...] = field(default=(), repr=False)
    motions: KnownMotions | None = field(default=None, repr=False)

    def part(self, rows: npt.NDArray[np.intp]) -> PathErrors:
        """The errors restricted to some points of the path."""
        names = ("amplitude", "at_frequency", "truncation", "is_same_curve", "ends_before", "contact_loads")
        arrays: dict[str, Any] = {name: getattr(self, name)[rows] for name in names}
        return replace(self, **arrays, contacts=self.contacts.part(rows))

    @property
    def on_same_branch(self) -> FloatArray:
        """Truncation error (point,) where the reference has the same branch; NaN elsewhere."""
        return np.where(self.is_same_curve, self.truncation, np.nan)


def errors_along(
    system: System,
    path: Path,
    quantities: ReportedQuantities | None = None,
    options: PairOptions = PAIR,
    budget: Budget | None = None,
) -> PathErrors:
    """Errors of a path of a system's balance; quantities are those reported along it, if known.

    They are unknown where the reference's own branch does not come to a frequency, see `with_nearest`.
    """
    quantities = quantities or reported_quantities(system, path)
    contacts = ContactRecord.at(system, path.z)
    size, folds, tops = (
        quantities.amplitude.max(axis=0),
        path.where(Mark.FOLD),
        quantities.amplitude.argmax(axis=0),
    )
    special = distinct_values(folds, path.where(Mark.PEAK), tops)
    share, met = _spectrum(system, path, quantities, special, size, options)
    more = reference_harmonics(system.harmonics, share, system.layout.ports, options)
    nothing = not share.any() and max(system.harmonics) < LIMITS.harmonics  # beyond that, shares are unknown
    reported = ReportedPath(path, quantities, _flat(contacts.contact_loads))
    if quantities.linear.all() or nothing:
        return _same_error(system, reported, contacts, share, 0.0)
    if more == system.harmonics:
        return _same_error(system, reported, contacts, share, np.nan)
    reference = ReferenceCurve(system, reported, more, options, budget or Budget(options.max_seconds))
    elsewhere = more
    if not reference.is_same_curve():
        elsewhere = affordable_reference(system, path, share, options)
    if elsewhere != more:  # it is followed with these harmonics only
        reference.stretches.budget = Budget(0.0)
    change = reference.displacements(np.concatenate((reference.distinct_points(special), folds, met)))
    reference.follow_stretches(change)
    compared = reference.compared_quantities(change)
    shift = reference.shifts(compared)
    contact_loads, greatest = contact_load_errors(reference, compared, shift, folds)
    shift = shift[:, : len(size)]
    of_peaks = peak_errors(reference, change)
    plain = _at_frequency(reference, shift, change)
    error = plain.copy()
    error[of_peaks.point, of_peaks.dof] = of_peaks.height / reference.unit[of_peaks.point, of_peaks.dof]
    raised = with_reference_errors(reference, error)
    at_frequency = np.where(raised > error, np.maximum(raised, plain), plain)
    error = raised
    error[folds] = at_frequency[folds] = np.nan  # the reference has two amplitudes at that frequency, or none
    comes: Mask = ~np.any(np.isnan(error), axis=1)
    at_points = error * reference.unit  # that of a peak may be the difference from a peak elsewhere
    height, told, frequency = _set_errors_of_peaks(reference, error, shift, change, met, of_peaks)
    unit, amplitude = reference.unit, quantities.amplitude
    at_rest = amplitude <= np.finfo(float).eps * unit  # within rounding
    for one in (error, at_frequency):
        one *= unit / np.where(at_rest, unit, amplitude)
    system.work.add(reference.seconds())
    of_folds = _of_folds(reference, folds, change)
    reference.release()
    return PathErrors(
        amplitude=error,
        at_frequency=at_frequency,
        truncation=_truncation(np.where(np.isnan(at_points), at_frequency * amplitude, at_points), amplitude),
        is_same_curve=comes,
        ends_before=reference.ends_before,
        peak=np.where(told, error[tops, np.arange(len(size))], np.nan),
        peak_frequency=frequency,
        height=height,
        fold=of_folds,
        share=share,
        reference=elsewhere,
        contact_loads=contact_loads,
        greatest=greatest,
        contacts=contacts,
        pieces=reference.pieces(compared),
        motions=reference.motions(),
    )


def _same_error(
    system: System, reported: ReportedPath, contacts: ContactRecord, share: FloatArray, error: float
) -> PathErrors:
    """Errors of a path that all have one value: 0 where the reference equals the curve, or NaN."""
    path, amplitude = reported.path, reported.quantities.amplitude
    every, exact = np.full_like(amplitude, error), not np.isnan(error)
    contact_loads = np.full((len(path.z), len(system.scene.contacts), 4), error)
    return PathErrors(
        amplitude=every,
        at_frequency=every,
        truncation=every[:, 0],
        is_same_curve=np.full(len(every), exact),
        ends_before=np.zeros(len(every), dtype=np.bool_),
        peak=every[0],
        peak_frequency=every[0],
        height=amplitude.max(axis=0),
        fold=np.full(len(path.where(Mark.FOLD)), error),
        share=share,
        reference=system.harmonics,
        contact_loads=contact_loads,
        greatest=contact_loads[0],
        contacts=contacts,
        pieces=(piece_of(reported),) if exact and len(path.z) > 1 else (),
    )


def unknown_errors(system: System, path: Path, quantities: ReportedQuantities) -> PathErrors:
    """Errors of a path with every entry unknown (NaN); `quantities` are those reported along the path."""
    contacts, nan = ContactRecord.at(system, path.z), np.nan
    none, unseen = np.full_like(quantities.amplitude, nan), np.zeros(len(path.z), dtype=np.bool_)
    contact_loads = np.full_like(contacts.contact_loads, nan)
    dofs, folds = np.full(none.shape[1], nan), np.full(len(path.where(Mark.FOLD)), nan)
    share = np.zeros(max(system.harmonics))
    return PathErrors(
        none, none, none[:, 0], unseen, unseen, dofs, dofs, dofs, folds, share, system.harmonics,
        contact_loads, np.full(contact_loads.shape[1:], nan), contacts,
    )  # fmt: skip


def with_nearest(
    system: System,
    paths: Sequence[Path],
    quantities: Sequence[ReportedQuantities],
    errors: Sequence[PathErrors],
    first: int = 0,
    options: PairOptions = PAIR,
) -> tuple[PathErrors, ...]:
    """Errors of the paths of a response, with the nearest motions where the reference's own branch has none.

    Where that branch does not come to a frequency, the error is the distance to the nearest known motion of
    the reference there. That may be on another branch, or where the branch has turned back. The error of a
    fold is the distance to the nearest fold.

    The nearest motion is another one: agreement in a single degree of freedom means nothing. Each therefore
    has at least the error of the greatest difference. A peak without a reference peak beside it is compared
    with the reference's greatest amplitude, if the reference is known at every frequency of the path. The
    paths before `first` have their errors already.
    """
    if all(one.is_same_curve.all() and not np.isnan(one.fold).any() for one in errors[first:]):
        return tuple(errors)
    every = list(errors)
    for k, further in enumerate(further_reference_pieces(system, paths, quantities, errors, first, options)):
        every[k] = replace(every[k], pieces=(*every[k].pieces, *further)) if further else every[k]
    pieces = [piece for one in every for piece in one.pieces]
    for k in range(first, len(every)):
        path, amplitude, dofs = paths[k], quantities[k].amplitude, quantities[k].amplitude.shape[1]
        if np.isnan(every[k].fold).any():
            every[k] = replace(every[k], fold=_with_nearest_folds(path, amplitude, every[k], pieces, options))
        rows = np.flatnonzero(~every[k].is_same_curve)
        if not rows.size or not pieces:
            continue
        now, error, contact_loads = amplitude[rows], every[k].amplitude.copy(), every[k].contact_loads.copy()
        parity = path.parity[rows]
        there = nearest(pieces, path.parameter[rows], parity, now)
        off = np.abs(there[:, :dofs] - now)
        error[rows] = np.maximum(off / np.where(now > 0.0, now, 1.0), _truncation(off, now)[:, None])
        at_frequency = every[k].at_frequency.copy()
        at_frequency[rows] = error[rows]
        bear = _flat(every[k].contacts.contact_loads)
        change = there[:, dofs:] - bear[rows]
        contact_loads[rows] = relative(change, bear[rows], bear.max(axis=0), options).reshape(
            len(rows), -1, 4
        )
        truncation = every[k].truncation.copy()
        truncation[rows] = _truncation(error[rows] * now, now)
        every[k] = replace(
            every[k],
            amplitude=error,
            at_frequency=at_frequency,
            truncation=truncation,
            contact_loads=contact_loads,
        )
        if np.isnan(every[k].height).any() and np.isfinite(there).all():
            every[k] = _with_greatest(every[k], amplitude, pieces)
    return tuple(every)


def _with_greatest(errors: PathErrors, amplitude: FloatArray, pieces: Sequence[CurvePiece]) -> PathErrors:
    """Errors of a path whose unknown peak errors are filled from the greatest amplitudes of all pieces.

    amplitude is (point, dof). `height` is the greatest amplitude of the path's own pieces. If the reference
    does not come to the frequency of a peak, the motion compared is another one. Each such peak then has at
    least the greatest error of all.
    """
    tops, top = amplitude.argmax(axis=0), amplitude.max(axis=0)
    own, every = (
        np.max([np.zeros_like(top), *(one.value[:, : len(top)].max(axis=0) for one in some)], axis=0)
        for some in (errors.pieces, pieces)
    )
    off, unknown = np.abs(every - top), np.isnan(errors.height)
    shared = np.where(errors.is_same_curve[tops], 0.0, off.max() / (top.max() or 1.0))
    error = np.maximum(off / np.where(top > 0.0, top, 1.0), shared)
    return replace(
        errors, height=np.where(unknown, own, errors.height), peak=np.where(unknown, error, errors.peak)
    )


def _flat(contact_loads: FloatArray) -> FloatArray:
    """Contact loads (point, contact, 4) as columns (point, 4 contact)."""
    return contact_loads.reshape(len(contact_loads), -1)


def _truncation(off: FloatArray, amplitude: FloatArray) -> FloatArray:
    """Greatest difference (point,) over the greatest amplitude, from differences (point, dof)."""
    most = amplitude.max(axis=1)
    truncation: FloatArray = off.max(axis=1) / np.where(most > 0.0, most, 1.0)
    return truncation


def _spectrum(
    system: System,
    path: Path,
    quantities: ReportedQuantities,
    special: Indices,
    size: FloatArray,
    options: PairOptions,
) -> tuple[FloatArray, Indices]:
    """Shares (harmonic,) of the harmonics left out, and the points where one of them meets a mode.

    A share is the harmonic's greatest amplitude without feedback, relative to size (dof,), at special points.
    Points where a harmonic meets a mode and dominates the others count as well.
    """
    further, arc = FurtherHarmonics(system), lengths(path)
    special = special[distinct(arc[special], options.peak_spacing * (arc[-1] - arc[0]))]
    met: Indices = further.resonances(path.z, quantities.amplitude)
    share = further.shares(path.z[special], np.tile(size, (len(special), 1))).max(axis=0)
    if met.size:  # it may dominate there, however small the motion is
        local = further.shares(path.z[met], quantities.amplitude[met])
        extends = local > options.leading_share * local.max(axis=1, keepdims=True)
        share = np.maximum(
            share, np.where(extends & (local > options.min_resonant_share), local, 0.0).max(axis=0)
        )
    return share[: LIMITS.harmonics], met


def _at_frequency(reference: ReferenceCurve, shift: FloatArray, change: FloatArray) -> FloatArray:
    """Errors (point, dof) at equal frequency, in the unit of `ReferenceCurve`."""
    error = np.where(reference.linear[:, None], 0.0, np.abs(shift))
    # displacements may cancel at a frequency, but the error of the reference itself does not
    moved = reference.weight[:, None] * np.abs(change[:, :1]) + np.abs(change[:, 1:])
    moved[np.isnan(moved).any(axis=1)] = 0.0  # where it was followed, the shifts alone count
    every: FloatArray = np.maximum(error, reference.options.reference_error * moved)
    return every


def _set_errors_of_peaks(
    reference: ReferenceCurve,
    error: FloatArray,
    shift: FloatArray,
    change: FloatArray,
    met: Indices,
    of_peaks: PeakErrors,
) -> tuple[FloatArray, Mask, FloatArray]:
    """Set the errors at the greatest amplitudes (dof,) of the curve.

    Returns the greatest amplitudes of the reference, whether the errors at them are known, and the errors of
    their frequencies.

    error (point, dof), in the unit of `ReferenceCurve`, is filled there with the difference in height. It
    includes the difference of a second reference, with still more harmonics; if that is not found and may
    matter, the error is unknown. If the reference is greatest at another peak, the error is the difference
    from that peak, or the error of the peak itself, whichever is greater.
    """
    path, amplitude, unit = reference.path, reference.quantities.amplitude, reference.unit
    own, d = amplitude.argmax(axis=0), np.arange(amplitude.shape[1])
    tops = tops_of_reference(reference, change[:, 1:], shift, met)
    height, settles = np.array([every[-1].height for every in tops]), ~reference.linear[own]
    inside = (own > 0) & (own < len(path.z) - 1)
    now = amplitude[own, d] + np.where(inside, rise_between_points(reference, np.zeros_like(unit), own), 0.0)
    own_height, frequency = of_peaks.at(own)
    for k in np.flatnonzero(np.isfinite(height)).tolist():
        settles[k] |= inside[k] or tops[k][-1].piece is not None or tops[k][-1].point != own[k]
        if not settles[k]:
            continue
        difference = abs(height[k] - now[k]) / unit[own[k], k]
        there = np.array([(top.height, *reference.error_at_top(top, k, difference)) for top in tops[k]])
        highest = there[:, 0] + there[:, 1]
        most = int(np.nanargmax(highest)) if np.isfinite(highest[-1]) else -1
        off = np.maximum(np.abs(highest[most] - now[k]), np.abs(there[most, 2]))
        apart = abs(reference.frequency_of(tops[k][most], change) / path.parameter[own[k]] - 1.0)
        if apart > reference.options.end_tolerance and np.isfinite(frequency[k]):
            off, frequency[k] = np.maximum(off, own_height[k]), apart
        error[own[k], k] = off / unit[own[k], k]
        height[k] = height[k] if np.isnan(off) else highest[most]
    return height, np.isfinite(height) | ~settles, frequency


def _of_folds(reference: ReferenceCurve, folds: Indices, change: FloatArray) -> FloatArray:
    """Relative errors (fold,) of the frequencies of folds.

    An error is the distance to the reference's fold beside it. Where the reference was followed and has as
    many folds, they are compared in order. NaN elsewhere.
    """
    error, parameter = np.full(len(folds), np.nan), reference.path.parameter
    of_reference = parameter * (1.0 + change[:, 0])
    for k, fold in enumerate(folds.tolist()):
        around = of_reference[max(fold - 2, 0) : fold + 3]
        if np.isfinite(around[[0, -1]]).all():  # the fold itself may be missed at a corner that has moved
            own = np.nanmax(around) if _side(parameter, fold) >= 0.0 else np.nanmin(around)
            error[k] = abs(own / parameter[fold] - 1.0)
        elif np.isfinite(of_reference[fold]):
            error[k] = abs(change[fold, 0])
    for one in reference.followed:
        mine = (one.first <= folds) & (folds < one.end)
        of_reference = np.concatenate(
            [np.empty(0), *(p.path.parameter[p.path.where(Mark.FOLD)] for p in one.pieces)]
        )
        if len(one.pieces) == 1 and len(of_reference) == mine.sum():
            error[mine] = np.abs(of_reference / parameter[folds[mine]] - 1.0)
    return error


def _with_nearest_folds(
    path: Path, amplitude: FloatArray, errors: PathErrors, pieces: Sequence[CurvePiece], options: PairOptions
) -> FloatArray:
    """Errors (fold,), with unknown ones replaced by the relative distance in frequency to the nearest fold.

    Only folds of the pieces at which the frequency turns back to the same side count. NaN if none is near.

    A fold is near if its amplitudes and its frequency are both within `PairOptions.end_tolerance`. One with
    the same amplitudes at another frequency is another fold.
    """
    error, folds, dofs = errors.fold.copy(), path.where(Mark.FOLD), amplitude.shape[1]
    turns = {side: [(one, one.turns(side)) for one in pieces] for side in (-1.0, 1.0)}
    there = {
        side: (
            np.concatenate([np.empty(0), *(one.frequency[at] for one, at in found)]),
            np.concatenate([np.empty((0, dofs)), *(one.value[at, :dofs] for one, at in found)]),
        )
        for side, found in turns.items()
    }
    for k in np.flatnonzero(np.isnan(error)).tolist():
        now, omega = amplitude[folds[k]], path.parameter[folds[k]]
        frequency, value = there[1.0 if _side(path.parameter, int(folds[k])) > 0.0 else -1.0]
        shift = np.abs(frequency / omega - 1.0)
        off = np.maximum(np.abs(value - now).max(axis=1, initial=0.0) / (float(now.max()) or 1.0), shift)
        if off.min(initial=np.inf) < options.end_tolerance:
            error[k] = shift[off.argmin()]
    return error


def _side(parameter: FloatArray, fold: int) -> float:
    """Height of a fold above the mean of its two neighbours, in the parameter; negative for a lower fold."""
    neighbours = parameter[[max(fold - 1, 0), min(fold + 1, len(parameter) - 1)]].mean()
    return float(parameter[fold] - neighbours)
