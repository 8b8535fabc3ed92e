"""Table: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ErrorOptions(Frozen):
    """How the error of a table is measured and checked."""

    points: int = 1_000_000  # random points at which a table is compared with the closed form
    # of these points: as good as any; recorded beside an error, so that it can be measured again
    seed: int = 1998
    chunk: int = 50_000  # points between two looks at the progress; a few megabytes
    max_change: float = 1e-3  # relative difference that other arithmetic may make at the same points


class ErrorMapOptions(Frozen):
    """Where the greatest error of a table is looked for."""

    zooms: int = 4  # times that the worst point is looked for on a finer grid around it
    finer: int = 10  # steps to each side of such a grid, together as wide as one step of the grid before
    boundary_points: int = 250  # points between two lines between regimes, crowded towards both
    rows: int = 401  # values of b_bar at which there are such points
    starts: int = 16  # points from which the worst one is sought, of each kind
    points_of_cell: int = 8  # points to a cell, along each axis, at which charts are compared where they meet


class NodeOptions(Frozen):
    """The nodes of a table, and how splines are evaluated between them."""

    max_nodes: int = 20_000_000  # nodes of a table; 20 times the default, half a gigabyte
    # well beyond, the slip regime is thinner than rounding errors allow to resolve
    max_slip_b: float = 1e4
    min_phi: float = 3e-6  # stands for the limit phi -> 0 of the slip regime where b >= 1
    margin: int = 1  # nodes around those reached by a part: a solver's path is another with another table
    # of u from an end, at least: there its derivative by n0 is infinite
    end_distance: float = 1e-14
    guard: int = 6  # nodes at a cut side, beyond which the splines are those through all nodes, to 1e-7
    newton_steps: int = 60  # of the inverse of a coordinate: the first ones gain a third only
    # multiplications of a matrix product that OpenBLAS does in one thread
    serial_multiplications: int = 200_000


class StudyOptions(Frozen):
    """The layouts of nodes that are compared with one another."""

    box: float = 3.0  # |n0_bar| and b_bar are at most this on a rectilinear grid; phi is in [0, pi]
    # of the nodes of the default table, along each axis
    shares: tuple[float, ...] = (0.25, 0.35, 0.5, 0.7, 1.0)
    points: int = 200_000  # sampled; about half of them lie in the box
    group: int = 10  # points of the small look-up that is timed, as a solver makes it
    repeats: int = 5  # of a timed look-up, of which the least counts


ERROR_OPTIONS = ErrorOptions()
MAP_OPTIONS = ErrorMapOptions()
NODE_OPTIONS = NodeOptions()
STUDY_OPTIONS = StudyOptions()
