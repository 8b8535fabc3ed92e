"""Build a table from the closed form: the nodes of the two charts and the reduced coefficients there."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fcm.contact import fourier_coefficients
from fcm.table import atlas
from fcm.table.atlas import FloatArray

PRESETS = {"default": (61, 31, 81, 61), "fast": (25, 13, 37, 27)}
SMALLEST_B = 1e-12  # stands for the limit b -> 0 of F / b
LARGEST_SLIP_B = 1e4  # the slip regime is thinner than rounding errors allow to resolve well beyond
SMALLEST_PHI = 3e-6  # stands for the limit phi -> 0 of the slip regime where b > 1

Progress = Callable[[int, int], None]


class Nodes(NamedTuple):
    """A chart's nodes, each of shape (nu, nx, nz)."""

    n0_bar: FloatArray
    b_bar: FloatArray
    phi: FloatArray


def separation_nodes(u: FloatArray, x: FloatArray, z: FloatArray) -> Nodes:
    """Nodes of the separation chart; where b = 0 they stand at SMALLEST_B."""
    U, X, Z = np.meshgrid(u, x, z, indexing="ij")
    phi = atlas.phi_phase(Z)
    b = np.maximum(atlas.b_variation(X, phi), SMALLEST_B)
    delta = atlas.delta_separation(U, b)
    n0 = b * np.cos(delta)
    # exactly on n0 = b the closed form is that of slip, which is the limit; on n0 = -b it is open
    n0 = np.where(U == 0.0, b, np.where(U == 1.0, -b, n0))
    return Nodes(n0, b, phi)


def slip_nodes(u: FloatArray, x: FloatArray, z: FloatArray) -> Nodes:
    """Nodes of the slip chart, moved to where its width can be resolved."""
    U, X, Z = np.meshgrid(u, x, z, indexing="ij")
    phi = atlas.phi_phase(Z)
    b = np.minimum(atlas.b_variation(X, phi), LARGEST_SLIP_B)
    away = SMALLEST_PHI * np.maximum(b, 0.1)
    phi = np.clip(phi, away, np.pi - away)
    width = atlas.geometry(b, atlas.Phase.of(phi)).width
    return Nodes(b + atlas.t_slip(U) * width, b, phi)


def reduced_separation(nodes: Nodes) -> FloatArray:
    """G = F (1 + b) / b, shape (nu, nx, nz, 3)."""
    F = np.stack(fourier_coefficients(*nodes), axis=-1)
    G: FloatArray = F * ((1.0 + nodes.b_bar) / nodes.b_bar)[..., None]
    return G


def reduced_slip(nodes: Nodes) -> FloatArray:
    """G = (F - F_edge) / E, shape (nu, nx, nz, 3)."""
    F_b, F_s, F_c = fourier_coefficients(*nodes)
    shape = atlas.geometry(nodes.b_bar, atlas.Phase.of(nodes.phi))
    edge = 0.5 * (shape.high - shape.low)
    return np.stack((F_b - edge, F_s - 1.0, F_c), axis=-1) / shape.width[..., None]


Resolution = tuple[int, int, int, int]  # nodes along u in separation, u in slip, x, z


def nodes(resolution: Resolution) -> Nodes:
    """The nodes of both charts one after the other along u, as they are: from n0 = -b up to the slip limit."""
    nu_1, nu_2, nx, nz = resolution
    x, z = np.linspace(0.0, 1.0, nx), np.linspace(0.0, 1.0, nz)
    U, X, Z = np.meshgrid(np.linspace(0.0, 1.0, nu_1)[::-1], x, z, indexing="ij")
    phi = atlas.phi_phase(Z)
    b = atlas.b_variation(X, phi)
    n0 = b * np.cos(atlas.delta_separation(U, b))
    n0[0], n0[-1] = -b[0], b[0]
    T = atlas.t_slip(np.linspace(0.0, 1.0, nu_2))[:, None, None]
    slip = b[:1] + T * atlas.geometry(b[:1], atlas.Phase.of(phi[:1])).width
    join = np.concatenate
    return Nodes(join((n0, slip)), join((b, b[:1] + 0.0 * T)), join((phi, phi[:1] + 0.0 * T)))


def resolution_of(separation: FloatArray, slip: FloatArray) -> Resolution:
    """Resolution of charts of shape (nu, nx, nz, 3)."""
    return separation.shape[0], slip.shape[0], separation.shape[1], separation.shape[2]


def charts(
    resolution: Resolution, progress: Progress | None = None
) -> tuple[FloatArray, FloatArray]:
    """Reduced coefficients at all nodes, one plane of constant u at a time."""
    nu_1, nu_2, nx, nz = resolution
    x, z = np.linspace(0.0, 1.0, nx), np.linspace(0.0, 1.0, nz)
    parts = []
    done = 0
    for nodes_of, reduced, count in (
        (separation_nodes, reduced_separation, nu_1),
        (slip_nodes, reduced_slip, nu_2),
    ):
        G = np.empty((count, nx, nz, 3))
        for k, u in enumerate(np.linspace(0.0, 1.0, count)):
            G[k] = reduced(nodes_of(np.array([u]), x, z))[0]
            done += 1
            if progress is not None:
                progress(done, nu_1 + nu_2)
        parts.append(G)
    parts[1][-1] = 0.0
    return parts[0], parts[1]
