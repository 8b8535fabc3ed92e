"""Two beams that three bolts hold in a lap joint, as those of Brake and Reuss: their first bending modes.

usage: python -m tests.studies.joint [OUT [ALONG ACROSS]]

It writes the matrices, the pairs, 20 along and 5 across the joint, the scene, both modes and their pictures
into OUT, build/joint, and prints frequency and damping against the amplitude; minutes.

The beams are of bricks with eight nodes and nine incompatible displacements (Taylor, Beresford and Wilson
1976), which bend without locking. Soft springs at their ends hang them up. Units are m, N and kg.

Source of the beam: M. R. W. Brake (ed.), The Mechanics of Jointed Structures, Springer 2018.
"""

from __future__ import annotations

import csv
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.sparse
import scipy.sparse.linalg
import xarray

from ..guide.gallery import small
from ..program import called

FloatArray = npt.NDArray[np.float64]
MODES = {7: "across the joint", 8: "along its plane"}  # first bending; six move the beams as one
LEVELS = 3e-6, 6e-4  # modal amplitudes
STEP = 0.1  # longest, of a decade of the amplitude
SHOWN = 1e-5, 1e-4, 5e-4  # of the map of slip


@dataclass(frozen=True)
class Beams:
    """The two beams, of steel, and what holds them.

    length, lap, width, height [m]; modulus [N/m^2], poisson, density [kg/m^3]; hung [N/m] in each direction
    at each of the two ends; bolts [m] from the left end, of a force each [N], whose pressure is a Gaussian of
    a breadth [m]; friction, and stiffness of the contact [N/m^3] along and across it.
    """

    length: float = 0.72
    lap: tuple[float, float] = (0.30, 0.42)
    width: float = 0.0254
    height: float = 0.0254
    modulus: float = 1.93e11
    poisson: float = 0.3
    density: float = 8000.0
    hung: float = 2e4
    bolts: tuple[float, ...] = (0.33, 0.36, 0.39)
    bolt_force: float = 4000.0
    breadth: float = 0.012
    mu: float = 0.6
    k_u: float = 6e12
    k_v: float = 1e13


class Mesh(NamedTuple):
    """Nodes (node, 3) of both beams, corners (brick, 8), and the pairs (pair, 2) with their areas (pair,)."""

    nodes: FloatArray
    corners: npt.NDArray[np.intp]
    pairs: npt.NDArray[np.intp]
    areas: FloatArray


CORNERS = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], dtype=float)
TURNED = [5, 4, 7, 6, 1, 0, 3, 2]  # the corners of a brick that was turned by half a turn about y


def brick(edges: FloatArray, beams: Beams) -> tuple[FloatArray, FloatArray]:
    """Stiffness and mass (24, 24) of a brick with three edges [m], x, y and z of each corner in turn.

    >>> K, M = brick(np.array([1.0, 2.0, 3.0]), Beams(density=1.0))
    >>> float(M[::3, ::3].sum().round(12)), bool(np.abs(K @ np.tile([1.0, 0.0, 0.0], 8)).max() < 1e-3)
    (6.0, True)
    """
    shear = 0.5 * beams.modulus / (1.0 + beams.poisson)
    law = np.diag([2.0 * shear] * 3 + [shear] * 3)
    law[:3, :3] += 2.0 * shear * beams.poisson / (1.0 - 2.0 * beams.poisson)
    volume = edges.prod() / 8.0  # of a point of Gauss
    k, m = np.zeros((33, 33)), np.zeros((24, 24))
    for point in CORNERS / np.sqrt(3.0):
        factors = 0.5 * (1.0 + CORNERS * point)
        slopes = [np.delete(factors, i, axis=1).prod(axis=1) * CORNERS[:, i] / edges[i] for i in range(3)]
        inner = np.diag(-4.0 * point / edges)  # of 1 - x^2 in each direction
        strain = np.zeros((6, 33))
        for first, columns in ((0, slopes), (24, list(inner))):
            for i, slope in enumerate(columns):
                for d in range(3):
                    at = slice(first + d, first + d + 3 * len(slope), 3)
                    if i == d:
                        strain[i, at] = slope
                    else:
                        strain[{1: 3, 3: 4, 2: 5}[i + d], at] = slope
        k += volume * strain.T @ law @ strain
        m += beams.density * volume * np.kron(np.outer(factors.prod(axis=1), factors.prod(axis=1)), np.eye(3))
    outer, both, own = k[:24, :24], k[:24, 24:], k[24:, 24:]
    return outer - both @ np.linalg.solve(own, both.T), m


def mesh(beams: Beams, along: int, across: int) -> Mesh:
    """Both beams, with along times across pairs of nodes over the lap."""
    begin, end = beams.lap
    x = np.concatenate((np.linspace(0.0, begin, 13)[:-1], np.linspace(begin, end, along)))
    y, z = np.linspace(-0.5, 0.5, across) * beams.width, np.linspace(-0.5, 0.5, 5) * beams.height
    number = np.arange(x.size * y.size * z.size).reshape(x.size, y.size, z.size)
    places = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    offsets = ((CORNERS + 1.0) / 2.0).astype(int).tolist()
    solid = np.ones(tuple(n - 1 for n in number.shape), dtype=bool)
    solid[12:, :, 2:] = False  # half the height over the lap
    nx, ny, nz = solid.shape
    bricks = np.stack([number[i : i + nx, j : j + ny, k : k + nz][solid] for i, j, k in offsets], axis=1)
    used = np.unique(bricks)
    bricks, face = np.searchsorted(used, bricks), np.searchsorted(used, number[12:, :, 2].ravel())
    own = places[used]
    turned = own * np.array([-1.0, 1.0, -1.0]) + np.array([beams.length, 0.0, 0.0])  # about y
    partner = [np.flatnonzero(np.abs(turned - one).max(axis=1) < 1e-9)[0] for one in own[face]]
    steps = [np.gradient(np.r_[one[0], one, one[-1]])[1:-1] for one in (x[12:], y)]  # what a node stands for
    return Mesh(
        np.concatenate((own, turned)),
        np.concatenate((bricks, bricks[:, TURNED] + used.size)),
        np.stack((face, np.array(partner) + used.size), axis=1),
        np.outer(*steps).ravel(),
    )


def matrices(beams: Beams, made: Mesh) -> tuple[scipy.sparse.csc_array, scipy.sparse.csc_array]:
    """Stiffness and mass of both beams on their springs, three rows for each node."""
    size, rows = made.nodes.size, (3 * made.corners[:, :, None] + np.arange(3)).reshape(-1, 24)
    edges = made.nodes[made.corners].max(axis=1) - made.nodes[made.corners].min(axis=1)
    kinds, which = np.unique(edges.round(9), axis=0, return_inverse=True)
    entries = [brick(one, beams) for one in kinds]
    at = np.repeat(rows, 24, axis=1).ravel(), np.tile(rows, (1, 24)).ravel()
    values = [np.array([one[i] for one in entries])[which.ravel()].ravel() for i in (0, 1)]
    K, M = (scipy.sparse.coo_array((one, at), shape=(size, size)).tocsc() for one in values)
    ends = [np.flatnonzero(np.abs(made.nodes[:, 0] - x) < 1e-9) for x in (0.0, beams.length)]
    spring = np.zeros(size)
    for nodes in ends:
        spring[(3 * nodes[:, None] + np.arange(3)).ravel()] = beams.hung / nodes.size
    return scipy.sparse.csc_array(K + scipy.sparse.diags_array(spring)), M


def preloads(beams: Beams, made: Mesh) -> FloatArray:
    """Of each pair: what the bolts press it with."""
    x, y, _ = made.nodes[made.pairs[:, 0]].T
    pressure = sum(np.exp(-((x - at) ** 2 + y**2) / (2.0 * beams.breadth**2)) for at in beams.bolts)
    share = pressure * made.areas
    found: FloatArray = len(beams.bolts) * beams.bolt_force * share / share.sum()
    return found


def write(
    folder: Path, along: int = 20, across: int = 5, harmonics: int = 3, beams: Beams | None = None
) -> Path:
    """The scene, with along times across pairs, and its files, in a folder."""
    beams = beams or Beams()
    made = mesh(beams, along, across)
    K, M = matrices(beams, made)
    folder.mkdir(parents=True, exist_ok=True)
    scipy.sparse.save_npz(folder / "stiffness.npz", K)
    scipy.sparse.save_npz(folder / "mass.npz", M)
    names = [f"{node + 1}{axis}" for node in range(len(made.nodes)) for axis in "xyz"]
    (folder / "dofs.txt").write_text("\n".join(names) + "\n", encoding="utf-8")
    with (folder / "pairs.csv").open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file)
        rows.writerow(("node", "other", "area", "n_0", "x", "y", "z"))
        for (one, other), area, load in zip(made.pairs, made.areas, preloads(beams, made), strict=True):
            place = made.nodes[one].round(9).tolist()
            rows.writerow((one + 1, other + 1, f"{area:.9g}", f"{load:.9g}", *place))
    path = folder / "joint.toml"
    path.write_text(SCENE.format(mu=beams.mu, harmonics=harmonics, **totals(beams)), encoding="utf-8")
    return path


SCENE = """title = "Two beams in a lap joint"
frequency_unit = "Hz"

[structure]
dofs      = "dofs.txt"
mass      = "mass.npz"
stiffness = "stiffness.npz"
damping   = 0.0005

[[contact]]
name       = "lap"
nodes      = "pairs.csv"
tangential = ["x", "y"]
normal     = "z"
mu  = {mu}
k_u = {k_u}
k_v = {k_v}

[[force]]
dof = "1z"
amplitude = 1.0

[response]
frequency = [10.0, 250.0]
harmonics = {harmonics}
output = ["1y", "1z"]

[units]
length = "m"
force = "N"
"""


def totals(beams: Beams) -> dict[str, float]:
    """Stiffness [N/m] of the whole contact, along and across it."""
    area = (beams.lap[1] - beams.lap[0]) * beams.width
    return {"k_u": beams.k_u * area, "k_v": beams.k_v * area}


def frequencies(K: scipy.sparse.csc_array, M: scipy.sparse.csc_array, count: int) -> FloatArray:
    """The lowest [Hz], of sparse matrices."""
    squares = scipy.sparse.linalg.eigsh(K, count, M, sigma=1.0, return_eigenvectors=False)
    return np.sqrt(np.sort(squares)) / (2.0 * np.pi)


def slender(beams: Beams) -> float:
    """First bending frequency [Hz] of one free beam, by Euler and Bernoulli."""
    speed = np.sqrt(beams.modulus / beams.density / 12.0)
    return float(4.730041**2 * beams.height / (2.0 * np.pi * beams.length**2) * speed)


def glued(beams: Beams, made: Mesh) -> FloatArray:
    """Both first bending frequencies [Hz] with all nodes at one place as one.

    They are one also where the end of a beam stands against the other.
    """
    K, M = matrices(beams, made)
    _, place = np.unique(made.nodes.round(7), axis=0, return_inverse=True)
    rows = (3 * place.ravel()[:, None] + np.arange(3)).ravel()
    glue = scipy.sparse.csc_array((np.ones(rows.size), (np.arange(rows.size), rows)))
    return frequencies(glue.T @ K @ glue, glue.T @ M @ glue, 8)[6:]


def stuck(beams: Beams, made: Mesh) -> FloatArray:
    """Both first bending frequencies [Hz] with all pairs as springs."""
    K, M = matrices(beams, made)
    k_u, k_v = totals(beams).values()
    share = np.repeat(made.areas / made.areas.sum(), 3) * np.tile([k_u, k_u, k_v], len(made.pairs))
    rows = [(3 * made.pairs[:, side, None] + np.arange(3)).ravel() for side in range(2)]
    pulls = scipy.sparse.csc_array(
        (np.repeat([1.0, -1.0], share.size), (np.concatenate(rows), np.tile(np.arange(share.size), 2))),
        shape=(K.shape[0], share.size),
    )
    return frequencies(K + pulls @ scipy.sparse.diags_array(share) @ pulls.T, M, 8)[6:]


def main(out: str = "build/joint", along: str = "20", across: str = "5") -> None:
    folder, beams = Path(out), Beams()
    scene, made = write(folder, int(along), int(across)), mesh(beams, int(along), int(across))
    print(f"first bending, one slender free beam: {slender(beams):.1f} Hz")
    for what, found in (("glued", glued(beams, made)), ("contacts that stick", stuck(beams, made))):
        print(f"first bending, {what}: {found[0]:.1f} and {found[1]:.1f} Hz")
    for number, name in MODES.items():
        result, span = folder / f"mode{number}.nc", ":".join(map(str, LEVELS))
        done = called("respond", scene, "--mode", number, "--level", span, "--max-step", STEP, "-o", result)
        print(done.err, file=sys.stderr)
        with xarray.open_dataset(result) as data:
            columns = "modal_amplitude", "frequency", "damping_ratio", "truncation_error"
            a, f, D, error = (data[column].values[0] for column in columns)
        print(f"bending {name}, mode {number}")
        for i in np.linspace(0, len(a) - 1, 12).round().astype(int):
            print(f"amplitude {a[i]:.3g}: {f[i]:.2f} Hz, damping {100.0 * D[i]:.3f} %")
        print(f"greatest change by twice as many harmonics: {np.nanmax(error):.2g}")
        called("plot", "mode", result, "-o", folder / f"mode{number}.png")
        at = [word for one in np.interp(np.log(SHOWN), np.log(a), f) for word in ("--at", one)]
        called("plot", "contacts", result, *at, "-o", folder / f"slip{number}.png")
        for picture in (folder / f"mode{number}.png", folder / f"slip{number}.png"):
            small(picture, picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
