"""The reference sought off the curve: from each motion once, and what is closed is followed one way."""

from dataclasses import replace

import numpy as np

from fcm.accuracy.embedded_pair import unknown_errors
from fcm.accuracy.options import PAIR
from fcm.accuracy.reference_branches import further_reference_pieces
from fcm.accuracy.reference_stretch import ReferencePiece, StretchFollower
from fcm.branches.trace import traced
from fcm.continuation import Path, Status
from fcm.harmonic_balance.reported_quantities import reported_quantities
from fcm.harmonic_balance.system import System
from fcm.scene import load_scene


def further(monkeypatch, part, most):
    """What is sought beside a path whose errors are unknown: the points that it is sought from, and the ways
    that it is followed. The first so many lead to a closed piece, that part of the path."""
    system = System(load_scene("yang1998-n5"), (1,))
    path = traced(system).branches.paths[0]
    begun, ways = [], []

    def start(follower, i, by_level):
        begun.append((i, by_level))
        return follower.finer.extended(path.z[i], system.harmonics) if len(begun) <= most else None

    def along(follower, z, direction, span, forward):
        ways.append(forward)
        finer = follower.finer
        z, direction = (finer.extended(of[part], system.harmonics) for of in (path.z, path.direction))
        mark, orientation = path.mark[part], path.orientation[part]
        ring = Path(z, direction, mark, orientation, Status.CLOSED, path.evaluations)
        return ReferencePiece(ring, reported_quantities(finer, ring), False)

    monkeypatch.setattr(StretchFollower, "start", start)
    monkeypatch.setattr(StretchFollower, "along", along)
    quantities = reported_quantities(system, path)
    errors = replace(unknown_errors(system, path, quantities), reference=(1, 2, 3))
    pieces = further_reference_pieces(system, [path], [quantities], [errors], 0, PAIR)
    return path, begun, ways, pieces[0]


def test_a_closed_piece_is_followed_one_way(monkeypatch):
    path, begun, ways, pieces = further(monkeypatch, slice(None), 1)
    assert len(begun) == len(ways) == len(pieces) == 1
    assert np.ptp(pieces[0].frequency) == np.ptp(path.parameter)


def test_where_a_motion_leads_nowhere_it_is_not_sought_again(monkeypatch):
    path, begun, _, pieces = further(monkeypatch, slice(0, 10), 1)
    assert len(pieces) == 1
    assert len(begun) == len(set(begun)) > len(path.z) / PAIR.point_interval
