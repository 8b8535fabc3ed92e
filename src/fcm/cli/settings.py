"""Settings of commands beside their options, for callers from Python."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from fcm import resources
from fcm.cli.limits import SENTENCES, RemarkOptions
from fcm.frozen import Frozen

if TYPE_CHECKING:
    from fcm.compare.options import CompareOptions
    from fcm.response.options import ResponseOptions
    from fcm.run import Factory
    from fcm.run.options import RunOptions
    from fcm.scene.options import MessageOptions


class Settings(Frozen):
    """Settings that no option covers: ``main(args, obj=Messages(settings=Settings(...)))``.

    Attributes
    ----------
    remarks : RemarkOptions
        How much is printed.
    reading : MessageOptions, optional
        How much is printed while a scene is read; None for the default.
    response : ResponseOptions, optional
        Tolerances and limits of responses.
    compare : CompareOptions, optional
        Tolerances and limits of ``--compare``.
    run : RunOptions, optional
        Waiting times for workers and schedulers.
    place : Factory, optional
        Where the curves of sweeps are computed, such as `fcm.run.place_of` an executor. Without it and
        ``--cluster``, they are computed in processes of this machine.
    memory : callable
        Memory [byte] that this process can still take.
    disk : callable
        Space [byte] that files in a folder can still take.
    clock : callable
        Time [s] since a fixed moment.
    """

    remarks: RemarkOptions = SENTENCES
    reading: MessageOptions | None = None
    response: ResponseOptions | None = None
    compare: CompareOptions | None = None
    run: RunOptions | None = None
    place: Factory | None = None
    memory: Callable[[], float] = resources.memory
    disk: Callable[[Path], float] = resources.disk
    clock: Callable[[], float] = time.monotonic


SETTINGS = Settings()
