"""Sentences on parts omitted from a calculation: what, why, and the effect."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from fcm.model.scene import Contact
from fcm.reduction.options import REDUCTION
from fcm.scene.errors import counted
from fcm.units import UNIT

if TYPE_CHECKING:
    from fcm.reduction.negligible_parts import ReducedScenes


def named(contacts: Sequence[Contact], numbers: Sequence[int]) -> str:
    """The first few contacts by name, or by number if they have none, and how many more there are."""
    names = [contacts[i].name or str(i) for i in numbers]
    more = f" and {len(names) - REDUCTION.max_names} more" if len(names) > REDUCTION.max_names else ""
    return f"contact{'' if len(names) == 1 else 's'} {', '.join(names[: REDUCTION.max_names])}{more}"


def on_modes(lighter: ReducedScenes, shift: float) -> str:
    """Sentence on the modes that were replaced, with a bound from the measured shift."""
    modal, fewer, unit = lighter.exact[0].modal, lighter.curves[0].modal, lighter.full[0].frequency_unit
    limit = lighter.above or 0.0
    high, few = (int((one.frequency > limit).sum()) for one in (modal, fewer))
    return (
        f"{counted(high, 'mode')} of {modal.frequency.size} above {limit / UNIT[unit]:.4g} {unit}, far above "
        f"the range: replaced by {few} with the same flexibility. This changes the response by less than "
        f"{2.0 * shift:.1e}, twice the most at the points checked"
    )


def on_means(lighter: ReducedScenes) -> list[str]:
    """Sentence on rigid-body modes whose mean does not affect any force; none without such modes."""
    from fcm.structure.rigid import settled

    adrift = max(int(np.count_nonzero(settled(scene)[1])) for scene in lighter.exact)
    if adrift == 0:
        return []
    what = counted(adrift, "rigid-body mode")
    if any(scene.strained for scene in lighter.exact):
        loads = " under the static loads" if any(scene.loads for scene in lighter.exact) else ""
        return [f"the mean of {what}, given as at rest{loads}: friction alone holds it there"]
    return [f"the mean of {what}, given as 0: no contact holds it along its normal, so nothing depends on it"]
