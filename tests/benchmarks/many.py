"""What many contacts take: a strip on a row of them, each part of a run against their number.

    python tests/benchmarks/many.py 25 50 100 200 --harmonics 1

prints seconds of processor time; the last line is the power of the number with which each part grows.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from fcm.branches.trace import traced
from fcm.harmonic_balance.system import System
from fcm.model.scene import Scene
from fcm.scene import scene_from_dict
from fcm.stability.bifurcations import stability

PARTS = "levels and curve", "stability"


def strip(contacts: int) -> Scene:
    """Nodes that slide along a foundation; its stiffness, preload and mass do not depend on their number."""
    n, rows = contacts, {}
    for link, ground in ((100.0, 20.0 / n), (30.0, 50.0 / n)):  # along, and across
        K = link * n * (2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
        K[0, 0] = K[-1, -1] = link * n
        rows[link] = np.linalg.eigh(n * (K + ground * np.eye(n)))
    none = np.zeros((n, n))
    along, across = rows[100.0], rows[30.0]
    shapes = np.sqrt(n) * np.block([[along[1].T, none], [none, across[1].T]])
    dofs = [f"{d}{i}" for d in "uv" for i in range(n)]
    return scene_from_dict(
        {
            "modal": {
                "dofs": dofs,
                "frequency": np.sqrt(np.concatenate((along[0], across[0]))).tolist(),
                "damping": [0.01] * len(dofs),
                "shapes": shapes.tolist(),
            },
            "contact": [
                {"name": f"c{i}", "tangential": f"u{i}", "normal": f"v{i}", "mu": 0.4}
                | {"k_u": 200.0 / n, "k_v": 300.0 / n, "n_0": 8.0 / n}
                for i in range(n)
            ],
            "force": [
                {"dof": f"u{n - 1}", "amplitude": 1.5},
                {"dof": f"v{n - 1}", "amplitude": 0.6},
            ],
            "response": {"frequency": [8.0, 20.0]},
        }
    )


def seconds(contacts: int, harmonics: int) -> list[float]:
    """Of each part."""
    system = System(strip(contacts), tuple(range(1, harmonics + 1)))
    begin = time.process_time()
    branches = traced(system).branches.paths
    middle = time.process_time()
    for path in branches:
        stability(system, path)
    return [middle - begin, time.process_time() - middle]


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("contacts", type=int, nargs="+")
    arguments.add_argument("--harmonics", type=int, default=1)
    given = arguments.parse_args()
    print("contacts", *PARTS, sep="\t")
    found = []
    for contacts in given.contacts:
        found.append(seconds(contacts, given.harmonics))
        print(contacts, *(f"{one:.2f}" for one in found[-1]), sep="\t", flush=True)
    if len(found) > 1:
        powers = np.polyfit(np.log(given.contacts), np.log(found), 1)[0]
        print("power", *(f"{one:.2f}" for one in powers), sep="\t")


if __name__ == "__main__":
    main()
