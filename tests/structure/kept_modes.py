"""Error of peak and frequency against the number of kept modes, with and without the others' flexibility.

    python tests/structure/kept_modes.py blade.toml 40z 3 5 10 20 30

SCENE has a [structure]; its curves are traced with so many modes, and compared with as many as there are,
or 300. Printed is the largest relative error over all curves, and the bound that a run states of its
receptances.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

import numpy as np

import fcm
from fcm.scene import scene_from_dict

MANY = 300


def peaks(path: Path, dof: str, **structure) -> tuple[np.ndarray, str]:
    """Amplitude and frequency of the peak of each curve, (curve, 2), and the bound as it is stated."""
    data = tomllib.loads(path.read_text())
    data["structure"] |= structure
    data["response"]["output"] = [dof]
    scene = scene_from_dict(data, str(path), path.parent)
    found = fcm.respond(scene, "closed-form").sel(dof=dof)
    stated = re.search(r"off by at most (\S+)", " ".join(scene.notes))
    return np.stack((found.peak_amplitude, found.peak_frequency), axis=-1), stated[1] if stated else "-"


def main(path: Path, dof: str, counts: list[int]) -> None:
    exact, _ = peaks(path, dof, modes=MANY)
    print("| modes | peak | its frequency | bound | peak without | its frequency |\n" + "| --- " * 6 + "|")
    for count in counts:
        cells = []
        for keep in (True, False):
            found, bound = peaks(path, dof, modes=count, flexibility=keep)
            error = np.abs(found / exact - 1.0).max(axis=0)
            cells += [f"{error[0]:.0e}", f"{error[1]:.0e}", *([bound] if keep else [])]
        print(f"| {count} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], [int(count) for count in sys.argv[3:]])
