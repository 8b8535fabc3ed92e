"""Options of runs: limits and waiting times of places, checkpoints and workers."""

from __future__ import annotations

from fcm.frozen import Frozen


class RunOptions(Frozen):
    """Waiting times and sizes of a sweep in several processes."""

    answer_interval: float = 0.05  # [s] between two looks at whether there is an answer
    max_set_aside: int = 1000  # most files that are moved aside for one output; with more the run is refused
    scheduler_answer: float = 10.0  # [s] time within which a scheduler has to answer
    first_worker: float = 30.0  # [s] time within which the first worker of a scheduler has to come
    # [s] time for which a scheduler may be without workers in the middle of a run
    without_workers: float = 60.0
    worker_interval: float = 2.0  # [s] between two looks at how many workers a scheduler has
    leave_time: float = 5.0  # [s] time for parting from a scheduler
    # number of batches that each worker has: one that it computes, one that waits for it
    batches_ahead: int = 2
    unknown_workers: int = 32  # number of workers assumed for an executor that does not tell it
    almost_done: float = 0.999  # greatest share shown of an unfinished batch
    poll: float = 0.1  # [s] between two looks at the progress of others
    # [s] time within which processes that are asked to stop may hand over what they have
    grace_time: float = 5.0
    progress_interval: float = 0.1  # [s] time between two reports of progress


RUN = RunOptions()
