"""Build a table from the closed form: the reduced coefficients at the nodes of the two charts."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from fcm.contact import fourier_coefficients
from fcm.table import arrays, atlas, store
from fcm.table.atlas import FloatArray
from fcm.table.constant_load_limit import vanishing_variation
from fcm.table.error import error_of, sample
from fcm.table.lookup import Table
from fcm.table.nodes import PRESETS, Nodes, axes, problem, separation_nodes, slip_nodes
from fcm.table.options import ERROR_OPTIONS
from fcm.table.partial_table import TablePart
from fcm.table.tabulated import Resolution

BUILT, MEASURED = 0.25, 0.95  # shares of the work that are then done

Progress = Callable[[float, str], None]


def build_table(
    path: str | Path,
    resolution: Resolution = PRESETS["default"],
    points: int = ERROR_OPTIONS.points,
    progress: Progress | None = None,
    history: str = "fcm.table.build_table",
    part: TablePart | None = None,
) -> Table:
    """Build a table from the closed form, measure its error, write it and return it.

    Parameters
    ----------
    path : str or Path
        The netCDF file to write. It is written completely or not at all.
    resolution : tuple of int
        Nodes along u in separation, along u in slip, along x, along z (see `fcm.table.atlas`), each 5 or
        more.
    points : int
        Number of points at which the error is measured.
    progress : callable, optional
        Called with the share of the work done, from 0 to 1, and a text.
    history : str
        Origin of the table, recorded in the file.
    part : TablePart, optional
        The nodes to build, all by default. Elsewhere the table evaluates the closed form.

    Raises
    ------
    ValueError
        If no table of the resolution can be made.
    OSError
        If the file cannot be written.
    """
    if reason := problem(resolution):
        raise ValueError(f"resolution {resolution}: {reason}")
    done = (lambda share, what: None) if progress is None else progress
    part = TablePart.all_of(resolution) if part is None else part
    stored = arrays.encode(*charts(part, lambda share: done(share * BUILT, "building")), part)
    table = Table(*arrays.decode(stored, part), part=part)  # with the rounding of the file
    done(BUILT, "measuring the error")
    table.error = error_of(
        table,
        points,
        progress=lambda share: done(BUILT + share * (MEASURED - BUILT), "measuring the error"),
        drawn=sample if part.whole else part.sample,
    )
    done(MEASURED, "writing")
    store.write(path, stored, table.error, history, part)
    return table


def charts(
    part: TablePart, progress: Callable[[float], None] = lambda share: None
) -> tuple[FloatArray, FloatArray]:
    """Reduced coefficients G at the nodes of separation and of slip, shapes (3, nu, nx, nz)."""
    u_1, u_2, x, z = axes(part)
    nu_1, nu_2 = u_1.size, u_2.size
    separation, slip = (np.empty((3, n, x.size, z.size)) for n in (nu_1, nu_2))
    limit = int(x[0] == 0.0)
    for k, u in enumerate(u_1):
        separation[:, k] = _reduced_separation(separation_nodes(u[None], x, z), limit)[:, 0]
        progress(k / (nu_1 + nu_2))
    for k, u in enumerate(u_2):
        slip[:, k] = _reduced_slip(slip_nodes(u[None], x, z, resolved=True))[:, 0]
        progress((nu_1 + k) / (nu_1 + nu_2))
    if limit:
        delta = atlas.delta_separation(u_1, np.zeros(1))
        separation[:, :, 0] = vanishing_variation(*np.meshgrid(delta, atlas.phi_phase(z), indexing="ij"))
    separation[:, u_1 == 1.0] = 0.0  # fully open
    slip[:, u_2 == 1.0] = 0.0  # at the slip limit
    return separation, slip


def _reduced_separation(nodes: Nodes, first: int) -> FloatArray:
    """G = F (1 + b) / b from the index `first` along x on; before it 0, as x = 0 is the limit b -> 0."""
    G = np.zeros((3, *nodes.b_bar.shape))
    n0, b, phi = (field[:, first:] for field in nodes)
    G[:, :, first:] = np.stack(fourier_coefficients(n0, b, phi)) * ((1.0 + b) / b)
    return G


def _reduced_slip(nodes: Nodes) -> FloatArray:
    """Reduced coefficients G = (F - F_edge) / E of the slip chart at its nodes."""
    F_b, F_s, F_c = fourier_coefficients(*nodes)
    shape = atlas.geometry(nodes.b_bar, nodes.phi)
    edge = 0.5 * (shape.high - shape.low)
    G: FloatArray = np.stack((F_b - edge, F_s - 1.0, F_c)) / shape.width
    return G
