"""Sweeps: many items computed in batches, here, in threads, in processes or on a cluster; kept until written.

Knows nothing of what is computed. `sweep` is given the batches and a function that computes one; `Checkpoint`
keeps what is finished; `fingerprint` says of what the results depend.
"""

from typing import TYPE_CHECKING

from fcm.lazy_import import on_demand
from fcm.run.checkpoint import Checkpoint, Results
from fcm.run.execution import IN_THIS_PROCESS, Execution
from fcm.run.fingerprint import fingerprint
from fcm.run.lock import CheckpointError
from fcm.run.places import Factory, Gone, Place, PlaceClosed, SerialPlace, Threads
from fcm.run.sweep import Outcome, place_for, place_of, sweep
from fcm.run.work import Compute, Interrupted, Lost, Progress, Report

if TYPE_CHECKING:
    from fcm.run.executor_place import ExecutorPlace
    from fcm.run.processes import Processes

__all__ = [
    "IN_THIS_PROCESS",
    "Checkpoint",
    "CheckpointError",
    "Compute",
    "Execution",
    "ExecutorPlace",
    "Factory",
    "Gone",
    "Interrupted",
    "Lost",
    "Outcome",
    "Place",
    "PlaceClosed",
    "Processes",
    "Progress",
    "Report",
    "Results",
    "SerialPlace",
    "Threads",
    "fingerprint",
    "place_for",
    "place_of",
    "sweep",
]

_HOME = {"ExecutorPlace": "executor_place", "Processes": "processes"}  # places that few runs need

__getattr__ = on_demand(__name__, _HOME)
