"""Sentences on a complete curve that falls short of the requested accuracy."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fcm.accuracy.refinement import RefinedResponse
from fcm.accuracy.stability_limits import StabilityLimit
from fcm.model.scene import InTime, Scene, in_time
from fcm.response.options import SENTENCES
from fcm.scene.errors import counted
from fcm.scene.options import LIMITS
from fcm.units import in_unit


def shortfall(
    found: RefinedResponse, lost: Sequence[StabilityLimit], accuracy: float, spent: float = 0.0
) -> str:
    """Sentence on why a curve misses the accuracy, and the cost of more harmonics; empty if it does not.

    lost: frequencies at which stability is lost without a fold, with their errors. spent: processor time [s]
    of the curve so far, with stability and errors, which more harmonics need as well.
    """
    if not found.reached:
        return _of_harmonics(found, accuracy, spent)
    off = [one for one in lost if not one.error <= accuracy]
    return _of_stability(found, off) if off else ""


def remedy(harmonics: Sequence[int], *, exact: bool = False) -> str:
    """Sentence on remedies for a curve with these harmonics, where no further ones are proposed.

    exact: whether the exact motion can be computed instead.

    >>> remedy((1, 2, 3), exact=True)
    'For smaller errors try --harmonics 6 or --method exact'
    >>> remedy(range(1, 51))
    '50 harmonics are the most, so ask for a greater --accuracy'
    """
    ways = []
    if (most := harmonics[-1]) < LIMITS.harmonics:
        ways.append(f"--harmonics {min(2 * most, LIMITS.harmonics)}")
    if exact:
        ways.append("--method exact")
    if not ways:
        return f"{most} harmonics are the most, so ask for a greater --accuracy"
    return f"For smaller errors try {' or '.join(ways)}"


def exact_is_advised(scene: Scene) -> bool:
    """Whether the exact motion of a scene can be computed, with few enough contacts to be fast."""
    return in_time(scene) is InTime.COMPUTED and len(scene.contacts) <= SENTENCES.contacts_in_time


def _remedy(found: RefinedResponse) -> str:
    return remedy(found.system.harmonics, exact=exact_is_advised(found.system.scene))


def _of_harmonics(found: RefinedResponse, accuracy: float, spent: float) -> str:
    """Sentence on too large errors of peaks and folds, and on the time that more harmonics would take."""
    folds, said = found.folds, _with_harmonics(found)
    unknown = np.count_nonzero(np.isnan(folds))
    if np.isnan(found.max_error) and np.isnan(found.peak[found.dofs_of_interest]).any():
        said += f" the errors of some peaks are unknown{_dofs_short(found, accuracy)}"
    elif unknown and found.max_known_error <= accuracy:
        said += f" the errors of {unknown} of {folds.size} folds are unknown"
    elif unknown:
        said += f" an estimated error of {found.max_known_error:.1e} remains{_dofs_short(found, accuracy)}"
        said += f"; the errors of {unknown} of {folds.size} folds are unknown"
    else:
        said += f" an estimated error of {found.max_error:.1e} remains{_dofs_short(found, accuracy)}"
    if not found.further:
        return f"{said}. {_remedy(found)}"
    more = found.further
    which = str(more[-1]) if more[-1] == len(more) else ",".join(map(str, more))
    if found.begun:
        most = found.system.options.work.max_seconds
        return (
            f"{said}. More harmonics were given up after some {most:.0f} s of work: --harmonics {which} "
            "uses them"
        )
    fewer = found.system.harmonics[-1] < SENTENCES.few_harmonics < len(more)
    middle = f", and --harmonics {SENTENCES.few_harmonics} takes less" if fewer else ""
    return (
        f"{said}. More harmonics would take some {_seconds(found, more, spent):.0f} s: --harmonics {which} "
        f"uses them{middle}"
    )


def _seconds(found: RefinedResponse, more: tuple[int, ...], spent: float) -> float:
    """Estimated seconds of a curve with more harmonics, to one digit.

    The time for tracing follows from the size of the equations. The time for errors and stability grows in
    proportion to the number of harmonics.
    """
    further = max(spent - found.seconds, 0.0) * len(more) / len(found.system.harmonics)
    whole = found.seconds_with(more) + further
    return float(f"{whole:.1g}") if whole > 1.0 else 1.0


def _dofs_short(found: RefinedResponse, accuracy: float) -> str:
    """Name the degrees of freedom whose peaks fall short, the worst first; empty if none do.

    If all do, name only the worst, and only if its peak is much lower than the greatest.
    """
    asked, dofs = found.dofs_of_interest, found.system.scene.modal.dofs
    off = np.flatnonzero(asked & ~(found.peak <= accuracy))
    if not off.size:
        return ""
    worst = off[np.argsort(-np.nan_to_num(found.peak[off], nan=np.inf), kind="stable")]
    if off.size == np.count_nonzero(asked):
        share = found.height[worst[0]] / found.height[asked].max()
        is_low = found.peak[worst[0]] == found.max_known_error and share < SENTENCES.low_peak
        return (
            f" (of {dofs[worst[0]]}, whose peak is {100.0 * share:.2g} % of the greatest)" if is_low else ""
        )
    more = f" and {off.size - SENTENCES.max_dofs} more" if off.size > SENTENCES.max_dofs else ""
    named = ", ".join(dofs[i] for i in worst[: SENTENCES.max_dofs])
    return f" (of {np.count_nonzero(asked)} peaks, those of {named}{more})"


def _of_stability(found: RefinedResponse, off: Sequence[StabilityLimit]) -> str:
    """Sentence on the frequency of a loss of stability that has the greatest error."""
    worst = max(off, key=lambda one: 0.0 if np.isnan(one.error) else one.error)
    error = "is unknown" if np.isnan(worst.error) else f"is estimated as {worst.error:.1e}"
    unit = found.system.scene.frequency_unit
    at = f"{in_unit(worst.frequency, unit):.6g} {unit}"
    return (
        f"{_with_harmonics(found)} the error of the frequency at which stability is lost, {at}, {error}. "
        f"{_remedy(found)}"
    )


def _with_harmonics(found: RefinedResponse) -> str:
    return f"with {counted(len(found.system.harmonics), 'harmonic')}"
