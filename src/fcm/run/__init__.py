"""Compute many items in batches, here, in processes or on a cluster, and keep results until written.

The package does not depend on what is computed. `compute_batches` takes the batches and a function that
computes one. `CheckpointFile` keeps finished batches. `fingerprint` identifies all that results depend on.
"""

from typing import TYPE_CHECKING

from fcm.lazy_import import on_demand
from fcm.run.batches import Outcome, compute_batches, place_for, place_of
from fcm.run.checkpoint_file import CheckpointFile, Results
from fcm.run.execution import IN_THIS_PROCESS, Execution
from fcm.run.fingerprint import fingerprint
from fcm.run.lock import CheckpointError
from fcm.run.places import Factory, Gone, Place, PlaceClosed, SerialPlace
from fcm.run.tasks import Compute, Interrupted, Lost, Progress, Report

if TYPE_CHECKING:
    from fcm.run.executor_place import ExecutorPlace
    from fcm.run.processes import Processes

__all__ = [
    "IN_THIS_PROCESS",
    "CheckpointError",
    "CheckpointFile",
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
    "compute_batches",
    "fingerprint",
    "place_for",
    "place_of",
]

_HOME = {"ExecutorPlace": "executor_place", "Processes": "processes"}  # places that few runs need

__getattr__ = on_demand(__name__, _HOME)
