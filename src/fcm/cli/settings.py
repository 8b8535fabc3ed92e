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
        How much is said.
    reading : MessageOptions, optional
        How much of it while a scene is read; the default where nothing is given.
    response : ResponseOptions, optional
        Tolerances and limits of responses.
    compare : CompareOptions, optional
        Those of ``--compare``.
    run : RunOptions, optional
        How long workers and schedulers are waited for.
    place : Factory, optional
        Where the curves of sweeps are computed, as `fcm.run.place_of` an executor says it; without it and
        ``--cluster`` in processes of this machine.
    memory : callable
        [byte] that this process can still take.
    disk : callable
        [byte] that files in a folder can still take.
    clock : callable
        [s] since some moment.
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
