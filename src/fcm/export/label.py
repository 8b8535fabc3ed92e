"""What an exported motion is called."""

from __future__ import annotations

import re
from collections.abc import Sequence

from fcm.results.motions import Motion
from fcm.units import in_unit

_OTHER = re.compile(r"[^A-Za-z0-9_.+-]+")


def labels_of(motions: Sequence[Motion], unit: str) -> list[str]:
    """A name for each motion, all different: its curve, its peak or frequency.

    >>> import numpy as np
    >>> nothing = np.zeros((0, 2, 2), dtype=complex)
    >>> motion = Motion(0, {}, ("16y",), 2.5, 1.0, (1,), nothing, None)
    >>> labels_of([motion, motion], "rad/s")
    ['peak_16y_2.5_rad_s', 'peak_16y_2.5_rad_s_2']
    """
    several, found = len({one.curve for one in motions}) > 1, list[str]()
    for one in motions:
        of = "_".join(["peak", *one.of[:1]]) if one.of else "at"
        text = f"{of}_{in_unit(one.frequency, unit):.6g}_{unit}"
        name = _OTHER.sub("_", f"curve{one.curve}_{text}" if several else text)
        count, first = 1, name
        while name in found:
            count += 1
            name = f"{first}_{count}"
        found.append(name)
    return found
