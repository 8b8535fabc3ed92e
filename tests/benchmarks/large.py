"""Random structures with many modes or many contacts: python tests/benchmarks/large.py [MODES CONTACTS]

Run time and memory of a curve of one harmonic, everything included; without arguments of the two sizes that
are aimed at: 500 modes and 20 contacts in 3 s, 20 modes and 50 contacts in 10 s and 500 MB, each in a process
of its own.
"""

from __future__ import annotations

import resource
import subprocess
import sys
import time

import numpy as np

from fcm.model.scene import Scene
from fcm.response import trace
from fcm.scene import scene_from_dict

SIZES = ((500, 20), (20, 50))


def random_scene(modes: int, contacts: int, seed: int = 0) -> Scene:
    """A range around the first resonances, contacts of which many slip and some separate."""
    rng = np.random.default_rng(seed)
    dofs = [f"x{i}" for i in range(2 * contacts + 1)]
    shapes = rng.normal(size=(modes, len(dofs))) / np.sqrt(modes)
    frequency = np.sort(np.concatenate(([1.0], rng.uniform(1.5, 0.5 * modes + 2.0, modes - 1))))
    contact = [
        {
            "name": f"c{i}",
            "tangential": dofs[2 * i],
            "normal": dofs[2 * i + 1],
            "mu": 0.4,
            "k_u": 0.3,
            "k_v": 0.3,
            "n_0": float(rng.uniform(-0.2, 0.5)),
        }
        for i in range(contacts)
    ]
    return scene_from_dict(
        {
            "modal": {
                "dofs": dofs,
                "frequency": frequency.tolist(),
                "damping": [0.01] * modes,
                "shapes": shapes.tolist(),
            },
            "contact": contact,
            "force": [{"dof": dofs[-1], "amplitude": 3.0}],
            "response": {"frequency": [0.9, 1.2], "harmonics": 1},
        }
    )


def run(modes: int, contacts: int) -> None:
    scene = random_scene(modes, contacts)
    begin = time.process_time()
    curve = trace(scene).curves[0]
    seconds = time.process_time() - begin
    megabytes = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(
        f"{modes} modes, {contacts} contacts: {seconds:.2f} s, {megabytes:.0f} MB; {curve.points} points, "
        f"{curve.evaluations} evaluations, complete: {curve.complete} {curve.reason}"
    )


def main() -> None:
    if len(sys.argv) == 3:
        run(int(sys.argv[1]), int(sys.argv[2]))
        return
    for size in SIZES:
        subprocess.run([sys.executable, __file__, *map(str, size)], check=True)


if __name__ == "__main__":
    main()
