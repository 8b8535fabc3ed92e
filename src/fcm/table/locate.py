"""Where points lie on the atlas, and the chain rule from its coordinates back to (n0_bar, b_bar, phi)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.table import atlas
from fcm.table.atlas import FloatArray, Geometry, Phase

BoolArray = npt.NDArray[np.bool_]
Resolution = tuple[int, int, int, int]  # nodes along u in separation, u in slip, x, z
NODES_BETWEEN = 3  # from the last node of separation to the first of slip in the stacked coefficients


class Place(NamedTuple):
    """F = base + scale G(q), with F_b (not F_s, F_c) to be multiplied by sign.

    Derivatives by (n0_bar, b_bar, phi)[j]: ``sum_k chain[j, k] (G, dG/dq)[k] + base_slopes[j]``, the
    last for F_b alone; both empty when they were not asked for.
    """

    q: FloatArray  # (3, p), in nodes, axis 0 through separation, then slip
    scale: FloatArray  # (p,)
    base: FloatArray  # (3, p)
    sign: FloatArray  # (p,)
    chain: FloatArray  # (3, 4, p)
    base_slopes: FloatArray  # (3, p)


# rows of what a chart says of its points
U, SCALE, BASE, CLOSED, U_N0, U_B, U_PHI, SCALE_B, SCALE_PHI, BASE_N0, BASE_B, BASE_PHI = range(12)


def locate(
    n0: FloatArray, b: FloatArray, phi: FloatArray, resolution: Resolution, derivatives: bool
) -> Place:
    """Places of points, shape (p,) each, all finite, b not negative."""
    nodes_1, nodes_2, nodes_x, nodes_z = resolution
    folded, sign = atlas.fold(phi)
    phase = Phase.of(folded)
    x, root_x_b, x_phi = atlas.x_variation(b, phase)
    z, z_phi = atlas.z_phase(folded)
    rows = _rows(n0, b, phase, (nodes_1 - 1, nodes_2 - 1), derivatives)
    q = np.array((rows[U], x * (nodes_x - 1), z * (nodes_z - 1)))
    base = np.zeros((3, n0.size))
    base[0], base[1] = rows[BASE], rows[CLOSED]
    scale = rows[SCALE]
    if not derivatives:
        return Place(q, scale, base, sign, np.empty(0), np.empty(0))
    chain = np.zeros((3, 4, n0.size))
    chain[1:, 0] = rows[SCALE_B : SCALE_PHI + 1]
    chain[:, 1] = rows[U_N0 : U_PHI + 1]
    scale_x = scale * (nodes_x - 1)
    chain[1, 2] = scale_x * root_x_b / np.sqrt(np.maximum(b, atlas.NEAR))
    chain[2, 2] = scale_x * x_phi
    chain[2, 3] = scale * z_phi * (nodes_z - 1)
    return Place(q, scale, base, sign, chain, rows[BASE_N0:])


def _rows(
    n0: FloatArray, b: FloatArray, phase: Phase, spans: tuple[int, int], derivatives: bool
) -> FloatArray:
    """The table of U to BASE_PHI (or to CLOSED), shape (12 or 4, p)."""
    opens = n0 < b
    count = np.count_nonzero(opens)
    if count == n0.size:
        return _separation(n0, b, spans[0], derivatives)
    if count == 0:
        return _slip(n0 - b, atlas.geometry(b, phase), phase, spans, derivatives)
    rows = np.empty((12 if derivatives else 4, n0.size))
    chosen = np.flatnonzero(opens)
    rows[:, chosen] = _separation(n0[chosen], b[chosen], spans[0], derivatives)
    chosen = np.flatnonzero(~opens)
    n0, b, phase = n0[chosen], b[chosen], phase.at(chosen)
    rows[:, chosen] = _slip(n0 - b, atlas.geometry(b, phase), phase, spans, derivatives)
    return rows


def _separation(n0: FloatArray, b: FloatArray, span: int, derivatives: bool) -> FloatArray:
    """Rows of points with n0 < b: F = b / (1 + b) G, and 0 for n0 <= -b."""
    safe_b = np.maximum(b, 1e-300)
    bounded = np.maximum(n0, -safe_b)
    below = np.maximum((safe_b - bounded) / safe_b, atlas.NEAR)  # 1 - n0 / b
    above = np.maximum((safe_b + bounded) / safe_b, atlas.NEAR)
    root_below, root_above = np.sqrt(below), np.sqrt(above)
    u, u_delta, u_b = atlas.u_separation(2.0 * np.arctan2(root_below, root_above), b)
    inside = (n0 > -b).astype(np.float64)
    layer = 1.0 / (1.0 + b)
    scale = b * layer * inside
    zero = np.zeros_like(b)
    if not derivatives:
        return np.array((u * span, scale, zero, zero))
    # d delta / d n0 = -1 / (b sin(delta)), d delta / d b = cos(delta) / (b sin(delta))
    u_n0 = u_delta * layer * inside / (root_below * root_above) * -span
    by_b = scale * u_b * span - u_n0 * (0.5 * (above - below))
    return np.array(
        (u * span, scale, zero, zero, u_n0, by_b, zero, layer * layer * inside, zero, zero, zero, zero)
    )


def _slip(
    excess: FloatArray, shape: Geometry, phase: Phase, spans: tuple[int, int], derivatives: bool
) -> FloatArray:
    """Rows of points with n0 - b = excess >= 0: F = F_edge + E G below the slip limit, F_edge above."""
    width = shape.width
    inside = excess < width
    t = np.minimum(
        np.maximum(np.minimum(excess, width) / np.maximum(width, 1e-300), atlas.NEAR), 1.0 - atlas.NEAR
    )
    u, u_t = atlas.u_slip(t)
    scale = width * inside
    mean = _mean_force(excess, shape)
    node = u * spans[1] + (spans[0] + NODES_BETWEEN)
    one = np.ones_like(t)
    if not derivatives:
        return np.array((node, scale, mean, one))
    ell_1_b, ell_2_b, ell_1_phi, ell_2_phi = shape.slopes(phase)
    by_t = u_t * inside * spans[1]
    width_b, width_phi = 0.5 * (ell_1_b + ell_2_b) - 1.0, 0.5 * (ell_1_phi + ell_2_phi)
    at_low, at_high = _shares(inside, mean)
    return np.array(
        (
            node,
            scale,
            mean,
            one,
            by_t,
            -(1.0 + t * width_b) * by_t,
            -t * width_phi * by_t,
            width_b * inside,
            width_phi * inside,
            at_high - at_low,
            at_low * ell_2_b - at_high * ell_1_b,
            at_low * ell_2_phi - at_high * ell_1_phi,
        )
    )


def _mean_force(excess: FloatArray, shape: Geometry) -> FloatArray:
    """Mean force of a contact that does not slip, the admissible one nearest to zero.

    Below the slip limit the one at the limit, where both bounds are F_edge.
    """
    reach = np.maximum(excess, shape.width)
    low, high = shape.high - reach, reach - shape.low
    return np.minimum(np.maximum(0.0, low), np.maximum(high, low))


def _shares(inside: BoolArray, mean: FloatArray) -> tuple[FloatArray, FloatArray]:
    """How much of the mean force's derivative is that of the lower bound, and of the upper."""
    half = 0.5 * inside
    return np.where(inside, half, mean > 0.0), np.where(inside, half, mean < 0.0)
