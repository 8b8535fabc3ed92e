"""Curves of solutions of n equations for n unknowns and a parameter; knows nothing of contacts."""

from fcm.continuation.all_branches import Branches, BranchesInterrupted, all_branches
from fcm.continuation.checkpoint import Checkpoint
from fcm.continuation.events import End, Events
from fcm.continuation.follow import follow
from fcm.continuation.options import FOLLOW, FollowOptions
from fcm.continuation.path import Mark, Path, PathInterrupted, Status
from fcm.continuation.problem import Problem
from fcm.continuation.segment import Segment

__all__ = [
    "FOLLOW",
    "Branches",
    "BranchesInterrupted",
    "Checkpoint",
    "End",
    "Events",
    "FollowOptions",
    "Mark",
    "Path",
    "PathInterrupted",
    "Problem",
    "Segment",
    "Status",
    "all_branches",
    "follow",
]
