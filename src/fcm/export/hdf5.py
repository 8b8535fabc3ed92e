"""Motions of all rows as HDF5, by h5py: arrays with the names of the rows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fcm.export.rows import StructureRows
from fcm.mesh import Mesh
from fcm.model.scene import Scene
from fcm.results.motions import ResponseMotion, harmonics_of
from fcm.units import in_unit


def write_hdf5(motions: Sequence[ResponseMotion], scene: Scene, mesh: Mesh | None, path: Path) -> None:
    """Write displacements of all rows.

    Datasets: row (row,) names; displacement (motion, harmonic, row) complex, as Im(X exp(i h omega t)), NaN
    for harmonics that a motion lacks; mean (motion, row); harmonic (harmonic,). `frequency`, `curve`,
    `stable` and `of` are (motion,), for nonlinear modes also `modal_amplitude`. With a mesh there are also
    node (node,) and xyz (node, 3).
    """
    import h5py

    rows, numbers = StructureRows.of(scene), harmonics_of(motions)
    waves = np.full((len(motions), len(numbers), len(rows.names)), np.nan, dtype=np.complex128)
    mean = np.empty((len(motions), len(rows.names)))
    for i, motion in enumerate(motions):
        found = rows.displacements(motion, scene)
        mean[i] = found[0].real
        waves[i, [numbers.index(h) for h in motion.harmonics]] = found[1:]
    with h5py.File(path, "w") as file:
        file.attrs["convention"] = "x = mean + Im(sum_h displacement_h exp(i h omega t))"
        file["row"] = np.array(rows.names, dtype=h5py.string_dtype())
        file["displacement"], file["mean"], file["harmonic"] = waves, mean, np.array(numbers)
        frequency = in_unit(np.array([one.frequency for one in motions]), scene.frequency_unit)
        file["frequency"] = frequency
        file["frequency"].attrs["units"] = scene.frequency_unit
        file["curve"] = np.array([one.curve for one in motions])
        file["stable"] = np.array([one.stable for one in motions])
        file["of"] = np.array([" ".join(one.of) for one in motions], dtype=h5py.string_dtype())
        if any(np.isfinite(one.amplitude) for one in motions):
            file["modal_amplitude"] = np.array([one.amplitude for one in motions])
        if mesh is not None:
            file["node"], file["xyz"] = np.array(mesh.nodes), mesh.xyz
