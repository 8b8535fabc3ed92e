"""A blade as a finite-element program gives it: matrices of a strip in plane stress, and its scene."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.sparse

FloatArray = npt.NDArray[np.float64]

LENGTH, WIDTH, THICKNESS = 0.2, 0.02, 0.005  # [m]
MODULUS, POISSON, DENSITY = 2.1e11, 0.3, 7800.0  # of steel, SI
ALONG, ACROSS = 50, 5  # elements
DAMPING = 0.002  # ratio
FORCE = 20.0  # [N] at the middle of the tip
STIFFNESS = 1e8  # [N/m] of the contact at a corner of the tip, in both directions
PRELOADS = (3000.0, 300.0, 30.0)  # [N]: it sticks throughout, slips much, and is all but open
CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])  # of an element


class Blade(NamedTuple):
    """Matrices without the clamped rows, and the names of the rows: node and direction."""

    stiffness: Any
    mass: Any
    dofs: list[str]
    corner: int  # nodes at the tip
    middle: int


def blade(along: int = ALONG, across: int = ACROSS) -> Blade:
    """The strip clamped at one end, of bilinear rectangles in plane stress.

    >>> made = blade(4, 2)
    >>> made.stiffness.shape, made.dofs[:3], made.dofs[-1]
    ((24, 24), ['4x', '4y', '5x'], '15y')
    """
    own_K, own_M = _element(LENGTH / along, WIDTH / across)
    nodes = np.arange((along + 1) * (across + 1)).reshape(along + 1, across + 1)
    corners = np.stack((nodes[:-1, :-1], nodes[1:, :-1], nodes[1:, 1:], nodes[:-1, 1:]), axis=-1)
    rows = (2 * corners.reshape(-1, 4)[..., None] + np.arange(2)).reshape(-1, 8)
    at = np.repeat(rows, 8, axis=1).ravel(), np.tile(rows, (1, 8)).ravel()
    size = 2 * nodes.size
    K, M = (
        scipy.sparse.coo_array((np.tile(one.ravel(), len(rows)), at), shape=(size, size)).tocsr()
        for one in (own_K, own_M)
    )
    free = slice(2 * (across + 1), None)
    names = [f"{node + 1}{direction}" for node in range(nodes.size) for direction in "xy"]
    tip = nodes[-1] + 1
    return Blade(K[free, free], M[free, free], names[free], int(tip[-1]), int(tip[across // 2]))


def _element(length: float, width: float) -> tuple[FloatArray, FloatArray]:
    """Stiffness and mass (8, 8) of a rectangle, by two points of Gauss in each direction."""
    elastic = np.array([[1.0, POISSON, 0.0], [POISSON, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - POISSON)]])
    elastic *= MODULUS / (1.0 - POISSON**2)
    area = 0.25 * length * width * THICKNESS
    K, M = np.zeros((2, 8, 8))
    for x, y in CORNERS / np.sqrt(3.0):
        ahead, aside = 1.0 + CORNERS[:, 0] * x, 1.0 + CORNERS[:, 1] * y
        by_x, by_y = 0.5 * CORNERS[:, 0] * aside / length, 0.5 * CORNERS[:, 1] * ahead / width
        strain, value = np.zeros((3, 8)), np.zeros((2, 8))
        strain[0, ::2] = strain[2, 1::2] = by_x
        strain[1, 1::2] = strain[2, ::2] = by_y
        value[0, ::2] = value[1, 1::2] = 0.25 * ahead * aside
        K += area * strain.T @ elastic @ strain
        M += area * DENSITY * value.T @ value
    return K, M


def blade_scene(made: Blade | None = None, preloads: tuple[float, ...] = PRELOADS) -> dict[str, Any]:
    """Its scene: a contact at a corner of the tip, a force at the middle, some preloads."""
    made = made or blade()
    contact = {"name": "tip", "tangential": f"{made.corner}y", "normal": f"{made.corner}x", "mu": 0.3}
    return {
        "title": "A blade of plane finite elements with a contact at its tip",
        "frequency_unit": "Hz",
        "structure": {
            "dofs": made.dofs,
            "stiffness": made.stiffness.toarray().tolist(),
            "mass": made.mass.toarray().tolist(),
            "damping": DAMPING,
        },
        "contact": [contact | {"k_u": STIFFNESS, "k_v": STIFFNESS, "n_0": preloads[0]}],
        "force": [{"dof": f"{made.middle}y", "amplitude": FORCE}],
        "response": {"frequency": [300.0, 2500.0], "harmonics": 1},
        "sweep": {"contact.tip.n_0": list(preloads)},
    }
