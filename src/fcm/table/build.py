"""Build a table from the closed form: the nodes of the two charts and the reduced coefficients there."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from fcm.contact import fourier_coefficients
from fcm.table import atlas
from fcm.table.atlas import FloatArray
from fcm.table.locate import Resolution

PRESETS: dict[str, Resolution] = {"default": (65, 17, 81, 71), "fast": (25, 9, 37, 29)}
LARGEST_SLIP_B = 1e4  # the slip regime is thinner than rounding errors allow to resolve well beyond
SMALLEST_PHI = 3e-6  # stands for the limit phi -> 0 of the slip regime where b > 1

Progress = Callable[[int, int], None]


class Nodes(NamedTuple):
    """A chart's nodes, each of shape (nu, nx, nz)."""

    n0_bar: FloatArray
    b_bar: FloatArray
    phi: FloatArray


def separation_nodes(u: FloatArray, x: FloatArray, z: FloatArray) -> Nodes:
    """Nodes of the separation chart. On n0 = b the closed form is that of slip, which is the limit."""
    U, X, Z = np.meshgrid(u, x, z, indexing="ij")
    phi = atlas.phi_phase(Z)
    b = atlas.b_variation(X, phi)
    delta = atlas.delta_separation(U, b)
    return Nodes(np.where(U == 1.0, -b, b * np.cos(delta)), b, phi)


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
    """G = F (1 + b) / b, shape (3, nu, nx, nz); x = 0 comes first and is the limit b -> 0."""
    G = np.empty((3, *nodes.b_bar.shape))
    b = nodes.b_bar[:, 1:]
    G[:, :, 1:] = np.stack(fourier_coefficients(nodes.n0_bar[:, 1:], b, nodes.phi[:, 1:])) * ((1.0 + b) / b)
    return G


def vanishing_variation(u: FloatArray, z: FloatArray) -> FloatArray:
    r"""Limit of F / b in separation as b -> 0, shape (3, nu, nz).

    The contact slips whenever it is closed, f = sign(cos(theta)) n, so with n / b = nu + sin(theta + phi) and
    nu = n0 / b = cos(delta) the coefficients are integrals of trigonometric functions between the ends
    of contact and the turning points -pi/2, pi/2.
    """
    delta, phi = np.meshgrid(atlas.delta_separation(u, np.zeros(1)), atlas.phi_phase(z), indexing="ij")
    nu = np.cos(delta)
    opening = 1.5 * np.pi - delta - phi
    closing = opening - 2.0 * (np.pi - delta)
    ends = [np.clip(turn * np.pi, closing, opening) for turn in (-1.5, -0.5, 0.5, 1.5)]
    before, on, to, after = (_primitive(theta, nu, phi) for theta in ends)
    G: FloatArray = ((to - on) - (on - before) - (after - to)) / np.pi
    return G


def _primitive(theta: FloatArray, nu: FloatArray, phi: FloatArray) -> FloatArray:
    """Of nu + sin(theta + phi) times 1/2, sin(theta), cos(theta)."""
    mean = 0.5 * (nu * theta - np.cos(theta + phi))
    sine = -nu * np.cos(theta) + 0.5 * (theta * np.cos(phi) - 0.5 * np.sin(2.0 * theta + phi))
    cosine = nu * np.sin(theta) + 0.5 * (theta * np.sin(phi) - 0.5 * np.cos(2.0 * theta + phi))
    return np.stack((mean, sine, cosine))


def reduced_slip(nodes: Nodes) -> FloatArray:
    """G = (F - F_edge) / E, shape (3, nu, nx, nz)."""
    F_b, F_s, F_c = fourier_coefficients(*nodes)
    shape = atlas.geometry(nodes.b_bar, atlas.Phase.of(nodes.phi))
    edge = 0.5 * (shape.high - shape.low)
    return np.stack((F_b - edge, F_s - 1.0, F_c)) / shape.width


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
    """Resolution of charts of shape (3, nu, nx, nz)."""
    return separation.shape[1], slip.shape[1], separation.shape[2], separation.shape[3]


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
        G = np.empty((3, count, nx, nz))
        for k, u in enumerate(np.linspace(0.0, 1.0, count)):
            G[:, k] = reduced(nodes_of(np.array([u]), x, z))[:, 0]
            done += 1
            if progress is not None:
                progress(done, nu_1 + nu_2)
        parts.append(G)
    parts[0][:, :, 0] = vanishing_variation(np.linspace(0.0, 1.0, nu_1), z)
    parts[0][:, -1] = 0.0
    parts[1][:, -1] = 0.0
    return parts[0], parts[1]
