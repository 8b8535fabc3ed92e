"""Run: tolerances and limits."""

from __future__ import annotations

from fcm.frozen import Frozen


class RunOptions(Frozen):
    """Waiting times and sizes of a sweep in several processes."""

    answer_interval: float = 0.05  # [s] between two looks at whether there is an answer
    max_set_aside: int = 1000  # files moved aside for one output; then it is refused
    scheduler_answer: float = 10.0  # [s] in which a scheduler has to answer
    first_worker: float = 30.0  # [s] in which the first worker of a scheduler has to come
    without_workers: float = 60.0  # [s] for which a scheduler may be without workers in the middle of a run
    worker_interval: float = 2.0  # [s] between two looks at how many workers a scheduler has
    leave_time: float = 5.0  # [s] to part from a scheduler
    batches_ahead: int = 2  # for each worker: one that it computes, one that waits for it
    unknown_workers: int = 32  # of an executor that does not say how many it has
    almost_done: float = 0.999  # of a batch that is not known to be finished
    poll: float = 0.1  # [s] between two looks at the progress of others
    grace_time: float = 0.8  # [s] in which those who are asked to stop may hand over what they have
    progress_interval: float = 0.1  # [s] between two words of progress


RUN = RunOptions()
