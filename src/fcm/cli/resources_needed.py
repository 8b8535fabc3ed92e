"""Report the resources that a large run needs, and refuse a run for which there is no room."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from fcm import resources
from fcm.cli.limits import REQUESTS
from fcm.cli.messages import Messages
from fcm.cli.respond_options import Asked
from fcm.files import real

if TYPE_CHECKING:
    from fcm.model.scene import Scene


def check_room(messages: Messages, scene: Scene, count: int, asked: Asked) -> None:
    """Report, before any curve is traced, what many curves need if that is much.

    Raises
    ------
    ResponseError
        If memory or disk cannot hold them. The message has the least need, the room, and a way to need less.
    """
    from fcm.response.request import ResponseError
    from fcm.results.size import bytes_of_matrices, bytes_of_results

    settings = messages.settings
    harmonics = asked.harmonics or scene.harmonics or (1,)
    results = bytes_of_results(scene, harmonics, asked.peaks_only, curves=count)
    matrices = bytes_of_matrices(scene, harmonics) if scene.has_range else 0.0
    contacts = len(scene.contacts)
    said = f"{count} curve{'s' * (count > 1)} of {contacts} contact{'s' * (contacts != 1)}"
    take = "take" if count > 1 else "takes"
    if results + matrices > (free := settings.memory()):
        raise ResponseError(
            f"{said} {take} at least {resources.size(results + matrices)} of memory, "
            f"and {resources.size(free)} are free: {_remedy(matrices > results, asked)}"
        )
    if results + matrices > settings.remarks.memory:
        messages.info(f"{said} {take} at least {resources.size(results + matrices)} of memory")
    if (seconds := _seconds_of_curve(scene, len(harmonics), asked)) > settings.remarks.long_curve:
        messages.info(
            f"{'each of ' * (count > 1)}{said} takes at least about {resources.duration(seconds)} of "
            f"processor time: less with {_lighter(harmonics, asked)}; --time-limit ends it"
        )
    for path, times in ((asked.output, 1.0), (asked.csv, REQUESTS.csv_size)):
        if path is not None and times * results > (left := settings.disk(_folder(path))):
            raise ResponseError(
                f"{path} takes at least {resources.size(times * results)}, "
                f"and {resources.size(left)} are free on its disk: {_remedy(False, asked)}, "
                "or write to another disk"
            )


def _folder(path: Path) -> Path:
    return real(path).parent


def _seconds_of_curve(scene: Scene, harmonics: int, asked: Asked) -> float:
    """Estimated seconds of the shortest run that traces a curve; 0 if none is traced."""
    from fcm.harmonic_balance.cost_model import seconds_of_curve

    if not scene.has_range or asked.at or asked.level is not None or asked.mode is not None:
        return 0.0
    return seconds_of_curve(scene, harmonics)


def _lighter(harmonics: Sequence[int], asked: Asked) -> str:
    one = "" if len(harmonics) == 1 and asked.harmonics else "one harmonic (--harmonics 1), "
    return f"{one}fewer contacts or fewer modes than half their directions"


def _remedy(matrices: bool, asked: Asked) -> str:
    if matrices:
        return "give fewer harmonics (--harmonics), fewer contacts, or fewer modes than half their directions"
    if asked.peaks_only:
        return "sweep or draw fewer values at a time"
    return "write the peaks alone (--peaks-only), sweep fewer values at a time, or report fewer dofs"
