"""What many contacts take, an elastic strip on a row of them: ``make bench-many``, or

    python -m tests.benchmarks.many 25 50 100 200 --harmonics 1 3 --sampled PYTHON

Processor time of whole processes of ``fcm respond``, everything included: the structure, branches, errors and
stability. Beside it, in the same run, that of a sampled balance, the curve alone.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.linalg
import scipy.sparse
import xarray
from tests.benchmarks.process import PROGRAM, seconds, used

FloatArray = npt.NDArray[np.float64]
SPAN, MODES, DAMPING = (8.0, 20.0), 30, 0.01  # of the strip, and of the sampled balance of it
SLIDES = {"mu": 0.4, "k_u": 200.0, "k_v": 300.0, "n_0": 8.0}  # mu, and totals of the strip
FORCES = 1.5, 0.6  # at its end, along and across


class Taken(NamedTuple):
    """Processor time [s], memory [GB], shares of points of known error and stability, peak of a dof."""

    seconds: float
    memory: float
    errors: float
    stability: float
    peak: float


def strip_matrices(contacts: int) -> tuple[FloatArray, FloatArray]:
    """Mass and stiffness of nodes on a foundation, all along and then all across, whose totals do not
    depend on their number."""
    n, blocks = contacts, []
    for link, ground in ((100.0, 20.0 / n), (30.0, 50.0 / n)):
        chain = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
        chain[0, 0] = chain[-1, -1] = 1.0
        blocks.append(link * n * chain + ground * np.eye(n))
    return np.eye(2 * n) / n, scipy.linalg.block_diag(*blocks)


def write_strip(folder: Path, contacts: int) -> Path:
    mass, stiffness = strip_matrices(contacts)
    for name, matrix in (("mass", mass), ("stiffness", stiffness)):
        scipy.sparse.save_npz(folder / f"{name}.npz", scipy.sparse.csc_array(matrix))
    names = [f"{node + 1}{axis}" for axis in "xy" for node in range(contacts)]
    (folder / "dofs.txt").write_text("\n".join(names) + "\n", encoding="utf-8")
    shares = {key: value if key == "mu" else value / contacts for key, value in SLIDES.items()}
    keys = "\n".join(f"{key} = {value!r}" for key, value in shares.items())
    contact = '[[contact]]\nname = "c{0}"\ntangential = "{0}x"\nnormal = "{0}y"\n{1}\n'
    force = '[[force]]\ndof = "{0}{1}"\namplitude = {2}\n'
    text = '[structure]\ndofs = "dofs.txt"\nmass = "mass.npz"\nstiffness = "stiffness.npz"\n'
    text += f"damping = {DAMPING}\n"
    text += "".join(contact.format(node + 1, keys) for node in range(contacts))
    text += "".join(force.format(contacts, axis, one) for axis, one in zip("xy", FORCES, strict=True))
    text += f'[response]\nfrequency = {list(SPAN)}\noutput = ["{contacts}x"]\n'
    of = shares | {"forces": FORCES, "span": SPAN, "damping": DAMPING, "modes": min(MODES, 2 * contacts)}
    (folder / "strip.json").write_text(json.dumps(of), encoding="utf-8")
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    return folder / "scene.toml"


def sampled(python: str, folder: Path, harmonics: str, samples: int) -> tuple[float, float]:
    """Processor time [s] and peak of the sampled balance of a strip."""
    program = Path(__file__).parent / "others" / "with_numba.py"
    words = [python, str(program), str(folder), harmonics, str(samples)]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    taken, peak = map(float, done.stdout.split())
    return taken, peak


def taken(scene: Path, harmonics: str) -> Taken:
    """By ``fcm respond`` with so many harmonics, or with the default accuracy."""
    words = () if harmonics == "default" else ("--harmonics", harmonics)
    found = used((*PROGRAM, "respond", scene.name, "-o", "result.nc", *words), scene.parent)
    with xarray.open_dataset(scene.parent / "result.nc") as data:
        here = np.isfinite(data["frequency"].values)
        shares = [
            float(np.isfinite(data[name].values[here]).mean()) for name in ("truncation_error", "stable")
        ]
        (shown,) = json.loads(data.attrs["output"])
        peak = float(np.nanmax(data["peak_amplitude"].sel(dof=shown).values))
    return Taken(seconds(found), found.ru_maxrss / 1e6, *shares, peak)


def strips(given: argparse.Namespace, folder: Path) -> None:
    print("contacts\tharmonics\there [s]\tGB\terrors known\tstability known\tsampled [s]\tpeaks apart")
    for harmonics in given.harmonics:
        times = []
        for contacts in given.contacts:
            one = taken(write_strip(folder, contacts), harmonics)
            times.append(one.seconds)
            beside = ("", "")
            if harmonics != "default" and given.sampled:
                other, peak = sampled(given.sampled, folder, harmonics, given.samples)
                beside = f"{other:.1f}", f"{abs(peak / one.peak - 1.0):.1e}"
            row(contacts, harmonics, one, *beside)
        if len(times) > 1:
            power = np.polyfit(np.log(given.contacts), np.log(times), 1)[0]
            print(f"grows as the power {power:.2f} of their number")


def row(contacts: int, harmonics: str, one: Taken, *beside: str) -> None:
    cells = f"{one.seconds:.1f}", f"{one.memory:.1f}", f"{one.errors:.0%}", f"{one.stability:.0%}"
    print(contacts, harmonics, *cells, *beside, sep="\t", flush=True)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    arguments.add_argument("contacts", nargs="+", type=int)
    arguments.add_argument("--harmonics", nargs="+", default=["1"], help="numbers, or default")
    arguments.add_argument("--sampled", help="a Python with numba, for the sampled balance")
    arguments.add_argument("--samples", type=int, default=128, help="of a cycle")
    given = arguments.parse_args()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    with tempfile.TemporaryDirectory() as folder:
        strips(given, Path(folder))


if __name__ == "__main__":
    main()
