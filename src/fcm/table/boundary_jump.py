"""How far the coefficients of a table jump where separation begins.

There, at n0_bar = b_bar, the splines of two charts meet: of F / beta, and of (F - F_edge) / E, see
`fcm.table.atlas`. At nodes both give the same F; between nodes each errs in its own way. The closed form, by
which solutions are corrected, has no jump.
"""

from __future__ import annotations

import numpy as np

from fcm.table.atlas import FloatArray, b_variation, phi_phase
from fcm.table.lookup import Table
from fcm.table.options import MAP_OPTIONS


def seam(table: Table) -> FloatArray:
    """The greatest jumps of F_b, F_s, F_c over the seam (3,)."""
    _, _, nodes_x, nodes_z = table.resolution
    x, z = (
        np.linspace(0.0, 1.0, MAP_OPTIONS.points_of_cell * (nodes - 1) + 1) for nodes in (nodes_x, nodes_z)
    )
    phi = phi_phase(z)[None, :] + np.zeros((x.size, 1))
    b = b_variation(x[:, None] + np.zeros(z.size), phi)
    before, beyond = (np.array(table(n0, b, phi)) for n0 in (np.nextafter(b, 0.0), b))
    jumps: FloatArray = np.abs(beyond - before).reshape(3, -1).max(axis=1)
    return jumps
