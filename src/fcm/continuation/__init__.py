"""Curves of solutions of n equations for n unknowns and a parameter; knows nothing of contacts."""

from fcm.continuation.between import Between
from fcm.continuation.branches import Branches, all_branches
from fcm.continuation.follow import follow
from fcm.continuation.path import Mark, Path, Status
from fcm.continuation.problem import Problem
from fcm.continuation.stage import Stage

__all__ = ["Between", "Branches", "Mark", "Path", "Problem", "Stage", "Status", "all_branches", "follow"]
