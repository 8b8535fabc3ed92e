"""Table: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class ErrorOptions(Frozen):
    """Options on how the error of a table is measured and checked."""

    points: int = 1_000_000  # number of random points at which a table is compared with the closed form
    # seed of these points; it is recorded with an error, so that this can be measured again
    seed: int = 1998
    chunk: int = 50_000  # number of points between two reports of progress; a few megabytes
    # relative difference of an error that another arithmetic may make at the same points
    max_change: float = 1e-3


class ErrorMapOptions(Frozen):
    """Options on where the greatest error of a table is sought."""

    zooms: int = 4  # number of times that the worst point is sought on a finer grid around it
    # number of steps to each side in such a grid, which together are one step of the grid before
    finer: int = 10
    boundary_points: int = 250  # number of points between two lines between regimes, graded towards both
    rows: int = 401  # number of values of b_bar at which there are such points
    starts: int = 16  # number of points of each kind from which the worst one is sought
    # number of points along each axis of a cell at which the two charts are compared where they meet
    points_of_cell: int = 8


class NodeOptions(Frozen):
    """Options on the nodes of a table and on its splines."""

    max_nodes: int = 20_000_000  # most nodes of a table: 20 times the default, half a gigabyte
    # greatest b of the slip regime: far beyond it, rounding errors do not resolve the regime
    max_slip_b: float = 1e4
    min_phi: float = 3e-6  # value in place of phi = 0 in the slip regime where b >= 1
    # number of nodes around those that a part of a table needs: another table leads a solver along another
    # path
    margin: int = 1
    end_distance: float = 1e-14  # least distance of u from an end, where its derivative by n0 is infinite
    # number of nodes at a cut side beyond which the splines equal those through all nodes, to 1e-7
    guard: int = 6
    # most Newton steps for the inverse of a coordinate: the first ones gain only a third
    newton_steps: int = 60
    # number of multiplications of a matrix product up to which OpenBLAS uses one thread
    serial_multiplications: int = 200_000


class StudyOptions(Frozen):
    """Options on the layouts of nodes that are compared in a study."""

    box: float = 3.0  # greatest |n0_bar| and b_bar on a rectilinear grid; phi is in [0, pi]
    # numbers of nodes along each axis, relative to those of the default table
    shares: tuple[float, ...] = (0.25, 0.35, 0.5, 0.7, 1.0)
    points: int = 200_000  # number of points that are sampled; about half of them lie in the box
    group: int = 10  # number of points of the small look-up that is timed, as by a solver
    repeats: int = 5  # number of times that a look-up is timed; the least time counts


ERROR_OPTIONS = ErrorOptions()
MAP_OPTIONS = ErrorMapOptions()
NODE_OPTIONS = NodeOptions()
STUDY_OPTIONS = StudyOptions()
