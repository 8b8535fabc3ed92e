"""The nodes of the atlas: a grid in (u, x, z) on each chart, as points (n0_bar, b_bar, phi)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.table import atlas
from fcm.table.atlas import FloatArray
from fcm.table.options import NODE_OPTIONS
from fcm.table.partial_table import TablePart
from fcm.table.tabulated import Resolution

PRESETS: dict[str, Resolution] = {"default": (65, 17, 81, 71), "fast": (25, 9, 37, 29)}
LEAST, MOST = 5, 2000  # nodes on an axis: needed by a spline, and more than any use needs


class Nodes(NamedTuple):
    """Points, each array of shape (nu, nx, nz)."""

    n0_bar: FloatArray
    b_bar: FloatArray
    phi: FloatArray


def unit(count: int) -> FloatArray:
    """Evenly spaced nodes from 0 to 1."""
    return np.linspace(0.0, 1.0, count)


def problem(resolution: Resolution) -> str:
    """Why no table of a resolution can be made; empty if it can."""
    nu_1, nu_2, nx, nz = resolution
    if not all(LEAST <= count <= MOST for count in resolution):
        return f"each axis has from {LEAST} to {MOST} nodes"
    total = (nu_1 + nu_2) * nx * nz
    return (
        f"{total} nodes in all are more than {NODE_OPTIONS.max_nodes}"
        if total > NODE_OPTIONS.max_nodes
        else ""
    )


def separation_nodes(u: FloatArray, x: FloatArray, z: FloatArray) -> Nodes:
    """Nodes of the separation chart; u = 0 is the onset of separation, u = 1 is fully open."""
    U, X, Z = np.meshgrid(u, x, z, indexing="ij")
    phi = atlas.phi_phase(Z)
    b = atlas.b_variation(X, phi)
    n0 = b * np.cos(atlas.delta_separation(U, b))
    return Nodes(np.where(U == 1.0, -b, np.where(U == 0.0, b, n0)), b, phi)


def slip_nodes(u: FloatArray, x: FloatArray, z: FloatArray, resolved: bool = False) -> Nodes:
    """Nodes of the slip chart; if resolved, moved to where its width exceeds the rounding errors of b."""
    U, X, Z = np.meshgrid(u, x, z, indexing="ij")
    phi = atlas.phi_phase(Z)
    b = atlas.b_variation(X, phi)
    if resolved:
        b = np.minimum(b, NODE_OPTIONS.max_slip_b)
        away = np.where(b < 1.0 - 1e-10, 0.0, NODE_OPTIONS.min_phi * b)
        phi = np.clip(phi, away, np.pi - away)
    return Nodes(b + atlas.t_slip(U) * atlas.geometry(b, phi).width, b, phi)


def axes(part: TablePart) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The nodes of a part along u in separation, u in slip, x and z."""
    first, second, third, fourth = (
        unit(count)[slice(*nodes)] for count, nodes in zip(part.resolution, part[1:], strict=True)
    )
    return first, second, third, fourth


def all_nodes(part: TablePart) -> Nodes:
    """The nodes of both charts in sequence, with n0 rising from -b to the slip limit."""
    u_1, u_2, x, z = axes(part)
    parts = separation_nodes(u_1[::-1], x, z), slip_nodes(u_2, x, z)
    return Nodes(*(np.concatenate(pair) for pair in zip(*parts, strict=True)))
