"""What a lap joint of many pairs takes: ``make bench-many``, or

    python -m tests.benchmarks.lap_joint 7x3 20x5 60x5 --line --harmonics 1 3 default

Processor time of whole processes of ``fcm respond``, everything included. The beams are those of ``make
joint``, held at the left end, with a corner pushed across. Soft springs hold the pairs together, and on a
line stiff ones tie them sideways.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path

import numpy as np
import scipy.sparse
from tests.benchmarks.many import taken
from tests.studies import joint

BEAMS = joint.Beams(mu=0.3)
SOFT = 1e-5  # springs between the pairs, of the contact's stiffness along
SCENE = """frequency_unit = "Hz"
[structure]
dofs      = "dofs.txt"
mass      = "mass.npz"
stiffness = "stiffness.npz"
damping   = 0.001
[[contact]]
name       = "lap"
nodes      = "pairs.csv"
tangential = {tangential}
normal     = "z"
mu  = {mu}
k_u = {k_u}
k_v = {k_v}
[[force]]
dof = "{pushed}"
amplitude = 2.0
[response]
frequency = [30.0, 60.0]
output = ["{pushed}"]
[units]
length = "m"
force = "N"
"""


def write(folder: Path, along: int, across: int, line: bool) -> Path:
    """The scene and its files, with so many pairs along and across the joint."""
    made = joint.mesh(BEAMS, along, across)
    joint.write(folder, along, across, beams=BEAMS)
    K = scipy.sparse.load_npz(folder / "stiffness.npz")
    for axis in range(3):
        share = 1.0 if line and axis == 1 else SOFT
        ones, count = np.ones(len(made.pairs)), np.arange(len(made.pairs))
        apart = scipy.sparse.coo_array(
            (ones, (3 * made.pairs[:, 0] + axis, count)), (len(K.indptr) - 1, len(ones))
        )
        apart -= scipy.sparse.coo_array((ones, (3 * made.pairs[:, 1] + axis, count)), apart.shape)
        K = K + apart @ scipy.sparse.diags_array(share * BEAMS.k_u * made.areas) @ apart.T
    names = np.array((folder / "dofs.txt").read_text(encoding="utf-8").split())
    free = np.flatnonzero(np.repeat(made.nodes[:, 0], 3) > 1e-9)
    scipy.sparse.save_npz(folder / "stiffness.npz", K.tocsc()[free][:, free])
    M = scipy.sparse.load_npz(folder / "mass.npz").tocsc()
    scipy.sparse.save_npz(folder / "mass.npz", M[free][:, free])
    (folder / "dofs.txt").write_text("\n".join(names[free]) + "\n", encoding="utf-8")
    corner = np.array([BEAMS.length, 0.0, 0.5 * BEAMS.height])
    pushed = int(np.abs(made.nodes - corner).sum(axis=1).argmin()) + 1
    tangential = '"x"' if line else '["x", "y"]'
    text = SCENE.format(tangential=tangential, mu=BEAMS.mu, pushed=f"{pushed}z", **joint.totals(BEAMS))
    (folder / "lap.toml").write_text(text, encoding="utf-8")
    return folder / "lap.toml"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("pairs", nargs="+", help="along and across the joint, as 20x5")
    arguments.add_argument("--harmonics", nargs="+", default=["1"], help="numbers, or default")
    arguments.add_argument("--line", action="store_true", help="pairs slide on a line")
    given = arguments.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    print("pairs\tharmonics\there [s]\tGB\terrors known\tstability known")
    with tempfile.TemporaryDirectory() as folder:
        for pairs in given.pairs:
            along, across = map(int, pairs.split("x"))
            scene = write(Path(folder), along, across, given.line)
            for harmonics in given.harmonics:
                one = taken(scene, harmonics)
                cells = f"{one.seconds:.1f}", f"{one.memory:.1f}", f"{one.errors:.0%}", f"{one.stability:.0%}"
                print(along * across, harmonics, *cells, sep="\t", flush=True)


if __name__ == "__main__":
    main()
