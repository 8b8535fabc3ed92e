"""``fcm tabulate --for SCENE``: the part of a table that a scene needs, and what it saves."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np

from fcm.cli.files import check_not_read
from fcm.cli.limits import REQUESTS
from fcm.cli.messages import Messages
from fcm.run import Progress
from fcm.table import TableError, open_table
from fcm.table.build import charts
from fcm.table.partial_table import ChartRanges, TablePart
from fcm.table.tabulated import Resolution


def reached(
    messages: Messages, scene: str, output: Path, resolution: Resolution, progress: Progress | None = None
) -> TablePart:
    """The nodes of a table that the response of a scene needs, found by a trace with the closed form.

    The output must not be a file of the scene.

    Raises
    ------
    TableError
        If no node is needed, because no contact slips or opens for part of a cycle.
    """
    from fcm.response import trace
    from fcm.run import Execution
    from fcm.scene import load_scene

    reach = ChartRanges(resolution)
    loaded = load_scene(scene)
    check_not_read({"-o": output}, loaded.files)
    response = trace(loaded, "closed-form", Execution(progress=progress), harmonics=1)
    if response.interrupted:
        raise KeyboardInterrupt
    messages.clear()
    for curve in response.curves:
        loops = curve.loop[np.isfinite(curve.frequency)].reshape(-1, curve.loop.shape[-1])
        reach.note(*loops[:, :3].T)
    part = reach.part()
    if part is None:
        raise TableError(f"{scene}: no contact slips, or opens in a part of its cycle, so it needs no table")
    if stopped := sum(not curve.complete for curve in response.curves):
        messages.warning(
            f"{scene}: curves that could not be traced to their ends: {stopped}; the part may lack some"
        )
    return part


def saving(path: Path, part: TablePart) -> tuple[dict[str, Any], str]:
    """How much smaller and faster the part of a table in a file is than the whole of its resolution.

    The whole is not built; its time is estimated in proportion to the number of nodes.
    """
    whole = TablePart.all_of(part.resolution)
    build = _seconds(lambda: charts(part), 1)
    opening = _seconds(lambda: open_table(path), REQUESTS.repeats)
    times = whole.nodes / part.nodes
    found = {
        "nodes": part.nodes,
        "nodes_of_all": whole.nodes,
        "bytes_of_all": _bytes(whole),
        "seconds_of_nodes": build,
        "seconds_of_all_nodes": build * times,
        "seconds_to_open": opening,
    }
    sentence = (
        f"{part.nodes} of {whole.nodes} nodes: {path.stat().st_size / 1e6:.2g} MB instead of "
        f"{_bytes(whole) / 1e6:.2g}; computed in {build:.2g} s instead of about {build * times:.2g}"
    )
    reference = _shipped(part.resolution)
    if reference is None:
        return found, f"{sentence}; opens in {1e3 * opening:.0f} ms"
    found["seconds_to_open_all"] = _seconds(lambda: open_table(reference), REQUESTS.repeats)
    return (
        found,
        f"{sentence}; opens in {1e3 * opening:.0f} ms instead of {1e3 * found['seconds_to_open_all']:.0f}",
    )


def _shipped(resolution: Resolution) -> Path | None:
    """The shipped table of this resolution; None if there is none."""
    from fcm.table.nodes import PRESETS
    from fcm.table.shipped import DEFAULT

    names = [name for name, preset in PRESETS.items() if preset == resolution]
    return DEFAULT.with_name(f"{names[0]}.nc") if names else None


def _bytes(part: TablePart) -> int:
    """Bytes of the file's large arrays: n0_bar, three coefficients at every node, three slopes in slip."""
    slip = part.nodes * (part.slip[1] - part.slip[0]) // sum(end - first for first, end in part[1:3])
    return 20 * part.nodes + 12 * slip


def _seconds(run: Any, times: int) -> float:
    """Least time [s] of several runs."""
    taken = []
    for _ in range(times):
        began = time.perf_counter()
        run()
        taken.append(time.perf_counter() - began)
    return min(taken)
