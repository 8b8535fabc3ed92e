"""Two elastic bodies that touch on an oblique plane, 26 nodes against 26, built with CalculiX.

usage: python -m tests.studies.oblique [OUT]

The study needs `ccx`. It writes the mesh, the matrices, the scene, the first nonlinear mode and its picture
into OUT, build/oblique. Then it prints the mode beside two limits that CalculiX finds by itself: the
first frequency of both bodies as one, and of one body alone.
"""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
import xarray

from ..guide.gallery import small
from ..program import called, ended

FloatArray = npt.NDArray[np.float64]
LENGTH, HEIGHT, WIDTH, ANGLE = 0.1, 0.03, 0.005, 30.0  # m; degrees of the plane to the cross section
ALONG, UP = 10, 12  # elements of each body, one across; 13 x 2 nodes on the plane
PRELOAD, STIFFNESS = 400.0, 2e9  # N, N/m of the whole plane
LEVELS = "1e-6:1e-4"  # modal amplitudes
MATERIAL = "*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1E11,0.3\n*DENSITY\n7850.\n"
MATERIAL += "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL\n"
MATRICES = "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n5\n*END STEP\n"
MODES = "*STEP\n*FREQUENCY\n3\n*END STEP\n"


def numbers(first: int) -> npt.NDArray[np.int64]:
    """Of the nodes of a body, (along, up, across)."""
    shape = (ALONG + 1, UP + 1, 2)
    return first + np.arange(np.prod(shape)).reshape(shape)


def places(right: bool) -> FloatArray:
    """Of the nodes of the left body, or the right one, (along, up, across, 3)."""
    part, y, z = np.meshgrid(
        np.linspace(0.0, 1.0, ALONG + 1), np.linspace(0.0, HEIGHT, UP + 1), (0.0, WIDTH), indexing="ij"
    )
    plane = LENGTH + (y - 0.5 * HEIGHT) * np.tan(np.radians(ANGLE))
    x = plane + part * (2.0 * LENGTH - plane) if right else part * plane
    return np.stack((x, y, z), axis=-1)


def mesh(glued: bool = False, alone: bool = False) -> str:
    """Of both bodies, which share the nodes of the plane if they are glued; or of the left one alone."""
    left = numbers(1)
    right = numbers(1 + left.size)
    if glued:
        right[0] = left[-1]
    bodies = [(left, places(False))] + ([] if alone else [(right, places(True))])
    nodes: dict[int, FloatArray] = {}
    elements = []
    for number, place in bodies:
        nodes |= dict(zip(number.ravel().tolist(), place.reshape(-1, 3), strict=True))
        corners = [number[i : i + ALONG, j : j + UP, k] for i, j, k in CORNERS]
        elements += np.stack(corners, axis=-1).reshape(-1, 8).tolist()
    held = np.concatenate([left[0].ravel(), [] if alone else right[-1].ravel()]).astype(int)
    lines = ["*NODE, NSET=NALL"]
    lines += [f"{node},{x:.12g},{y:.12g},{z:.12g}" for node, (x, y, z) in sorted(nodes.items())]
    lines.append("*ELEMENT, TYPE=C3D8, ELSET=EALL")
    lines += [f"{i},{','.join(map(str, one))}" for i, one in enumerate(elements, 1)]
    if not (glued or alone):
        for name, plane in (("LEFT", left[-1]), ("RIGHT", right[0])):
            lines += [f"*NSET, NSET={name}", *(f"{node}," for node in plane.ravel().tolist())]
    return "\n".join([*lines, f"{MATERIAL}*BOUNDARY", *(f"{node},1,3" for node in held.tolist()), ""])


CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def calculated(folder: Path, name: str, text: str) -> Path:
    """A run of CalculiX."""
    (folder / f"{name}.inp").write_text(text, encoding="utf-8")
    done = ended("ccx", name, cwd=folder)
    if done.code:
        raise RuntimeError(f"ccx {name}: {done.out[-300:]}")
    return folder / name


def frequencies(folder: Path, name: str, text: str) -> list[float]:
    """First of a structure [Hz], as CalculiX prints them."""
    printed = calculated(folder, name, text + MODES).with_suffix(".dat").read_text(encoding="utf-8")
    rows = re.findall(r"^ +\d+ +(\S+) +(\S+) +(\S+) +(\S+)$", printed, re.M)
    return [float(row[2]) for row in rows[:3]]


def scene(folder: Path, stiffness: float = STIFFNESS) -> Path:
    """The scene beside the matrices that CalculiX has written."""
    if not (folder / "bodies.sti").exists():
        calculated(folder, "bodies", mesh() + MATRICES)
    driven = int(numbers(1)[ALONG, UP // 2, 0]) - (UP + 1) * 2  # one element before the plane
    text = f"""title = "Two bodies on an oblique plane"
frequency_unit = "Hz"

[structure]
stiffness = "bodies.sti"
mass = "bodies.mas"
damping = 0.002
modes = 12

[[contact]]
name = "plane"
nodes = {{ sets = ["LEFT", "RIGHT"], mesh = "bodies.inp", tolerance = 1e-6 }}
normal = "fitted"
tangential = "fitted"
areas = "equal"
mu = 0.3
k_u = {stiffness}
k_v = {stiffness}
n_0 = {PRELOAD}

[[force]]
dof = "{driven}z"
amplitude = 1.0

[response]
frequency = [600.0, 1250.0]
harmonics = 1
"""
    path = folder / "oblique.toml"
    path.write_text(text, encoding="utf-8")
    return path


def main(out: str = "build/oblique") -> None:
    if shutil.which("ccx") is None:
        sys.exit("the study needs CalculiX: ccx is not installed")
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    result = folder / "oblique.nc"
    done = called("respond", scene(folder), "--mode", "1", "--level", LEVELS, "-o", result)
    print(done.err, file=sys.stderr)
    glued = frequencies(folder, "glued", mesh(glued=True))[0]
    alone = frequencies(folder, "alone", mesh(alone=True))[0]
    print(f"CalculiX: as one {glued:.1f} Hz, one alone {alone:.1f} Hz")
    with xarray.open_dataset(result) as data:
        mode = data.isel(curve=0)
        names = "modal_amplitude", "frequency", "damping_ratio"
        for amplitude, frequency, damping in np.column_stack([mode[name].values for name in names])[::10]:
            print(f"amplitude {amplitude:.3g}: {frequency:.1f} Hz, damping {100.0 * damping:.3f} %")
    picture = folder / "oblique.png"
    called("plot", "mode", result, "-o", picture)
    small(picture, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
