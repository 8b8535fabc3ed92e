"""Sweeps: many items computed in batches, here, in threads, in processes or on a cluster; kept until written.

Knows nothing of what is computed. `sweep` is given the batches and a function that computes one; `Checkpoint`
keeps what is finished; `fingerprint` says of what the results depend.
"""

from fcm.run.checkpoint import Checkpoint, CheckpointError, Results
from fcm.run.elsewhere import Elsewhere
from fcm.run.fingerprint import fingerprint
from fcm.run.places import Factory, Gone, Here, Place, Threads
from fcm.run.processes import Processes
from fcm.run.sweep import Outcome, place_for, place_of, sweep
from fcm.run.work import Compute, Interrupted, Lost, Progress, Report

__all__ = [
    "Checkpoint",
    "CheckpointError",
    "Compute",
    "Elsewhere",
    "Factory",
    "Gone",
    "Here",
    "Interrupted",
    "Lost",
    "Outcome",
    "Place",
    "Processes",
    "Progress",
    "Report",
    "Results",
    "Threads",
    "fingerprint",
    "place_for",
    "place_of",
    "sweep",
]
