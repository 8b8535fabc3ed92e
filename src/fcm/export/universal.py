"""Motions for test software: a universal file with nodes (2411), shapes (55) and spectra (58)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from fcm.export.motions import labels_of
from fcm.export.rows import StructureRows
from fcm.mesh import Mesh
from fcm.model.scene import FloatArray, Scene
from fcm.results.motions import ComplexArray, ResponseMotion
from fcm.results.result import Curve, Response
from fcm.scene.names import DIRECTIONS, motion_of
from fcm.units import in_unit

_ANALYSIS, _DISPLACEMENT, _COMPLEX = 5, 8, 5  # frequency response, of displacements, complex
_SPECTRUM, _DOUBLE_COMPLEX, _FREQUENCY = 12, 6, 18


def write_universal(
    motions: Sequence[ResponseMotion], response: Response, scene: Scene, mesh: Mesh | None, path: Path
) -> None:
    """Write a universal file; frequencies are in Hz, as its readers expect.

    With a mesh, dataset 2411 has the nodes. Each motion and harmonic has a dataset 55: complex, at all nodes
    with rows, with the five digits of the format. Each reported degree of freedom of a node and each stretch
    of a curve between two folds has a dataset 58: the complex fundamental over the frequency, in double
    precision. Nonlinear modes have none. Phases are relative to sin(omega t), as those of the forces.
    """
    rows = StructureRows.of(scene)
    with path.open("w", encoding="ascii", newline="\n") as file:
        if mesh is not None:
            file.writelines(_dataset(2411, _nodes(mesh)))
        step = 0
        for motion, name in zip(motions, labels_of(motions, scene.frequency_unit), strict=True):
            found = rows.by_node(rows.displacements(motion, scene), rows.nodes)
            for j, harmonic in enumerate(motion.harmonics, 1):
                step += 1
                hertz = harmonic * motion.frequency / (2.0 * np.pi)
                text = _shape(rows, found[j], f"{name} harmonic {harmonic}", hertz, step)
                file.writelines(_dataset(55, text))
        for number, curve in enumerate(response.curves):
            if curve.mode is not None:  # a free motion answers to no force
                continue
            for d, dof in enumerate(response.dofs):
                if motion_of(dof):
                    for stretch in _between_folds(curve):
                        file.writelines(_dataset(58, _spectrum(curve, number, d, dof, stretch)))


def _dataset(number: int, lines: Iterator[str]) -> Iterator[str]:
    yield f"    -1\n{number:6d}\n"
    for line in lines:
        yield f"{line}\n"
    yield "    -1\n"


def _nodes(mesh: Mesh) -> Iterator[str]:
    for node, xyz in zip(mesh.nodes, mesh.xyz, strict=True):
        yield f"{node:10d}{1:10d}{1:10d}{11:10d}"
        yield "".join(f"{x:25.16E}" for x in xyz).replace("E", "D")


def _shape(rows: StructureRows, values: ComplexArray, name: str, hertz: float, step: int) -> Iterator[str]:
    """Lines of a universal file for one complex shape of all nodes (node, 6)."""
    count = 6 if rows.turn else 3
    yield from (name[:80], "displacement, Im(X exp(i h omega t))", "NONE", "NONE", "NONE")
    kind = 3 if rows.turn else 2
    yield "".join(f"{x:10d}" for x in (1, _ANALYSIS, kind, _DISPLACEMENT, _COMPLEX, count))
    yield "".join(f"{x:10d}" for x in (2, 1, 1, step))
    yield f"{hertz:13.5E}"
    for node, row in zip(rows.nodes.tolist(), values[:, :count], strict=True):
        yield f"{node:10d}"
        words = [f"{x:13.5E}" for value in row.tolist() for x in (value.real, value.imag)]
        for i in range(0, len(words), 6):
            yield "".join(words[i : i + 6])


def _between_folds(curve: Curve) -> list[slice]:
    """Stretches of a curve along which the frequency rises or falls, without the gaps between branches."""
    turns = [0]
    step = np.sign(np.diff(curve.frequency))
    for k in range(1, curve.frequency.size):
        gap = np.isnan(step[k - 1])
        if gap or (k > 1 and step[k - 1] != step[k - 2] and not np.isnan(step[k - 2])):
            turns.append(k if gap else k - 1)
    ends = [*turns[1:], curve.frequency.size - 1]
    found = []
    for first, last in zip(turns, ends, strict=True):
        there = np.flatnonzero(np.isfinite(curve.frequency[first : last + 1])) + first
        if there.size > 1:
            found.append(slice(int(there[0]), int(there[-1]) + 1))
    return found


def _spectrum(curve: Curve, number: int, d: int, dof: str, stretch: slice) -> Iterator[str]:
    """The fundamental of a degree of freedom along a stretch, with rising frequency."""
    hertz: FloatArray = in_unit(curve.frequency[stretch], "Hz")
    value = curve.fundamental[stretch, d] * np.exp(1j * curve.phase[stretch, d])
    if hertz[0] > hertz[-1]:
        hertz, value = hertz[::-1], value[::-1]
    word = motion_of(dof)
    letters = word.lstrip("0123456789")
    node, direction = int(word.removesuffix(letters)), 1 + DIRECTIONS.index(letters)
    yield from (f"curve {number}, fundamental of {dof}", "Im(X exp(i omega t))", "NONE", "NONE", "NONE")
    yield (
        f"{_SPECTRUM:5d}{number:10d}{0:5d}{0:10d} {'NONE':<10}{node:10d}{direction:4d}"
        f" {'NONE':<10}{0:10d}{0:4d}"
    )
    yield f"{_DOUBLE_COMPLEX:10d}{hertz.size:10d}{0:10d}{0.0:13.5E}{0.0:13.5E}{0.0:13.5E}"
    axes = ((_FREQUENCY, "Frequency", "Hz"), (_DISPLACEMENT, "Displacement", "NONE"), (0, "NONE", "NONE"))
    for kind, what, unit in (*axes, (0, "NONE", "NONE")):
        yield f"{kind:10d}{0:5d}{0:5d}{0:5d} {what:<20} {unit:<20}"
    for x, y in zip(hertz.tolist(), value.tolist(), strict=True):
        yield f"{x:13.5E}{y.real:20.12E}{y.imag:20.12E}"
