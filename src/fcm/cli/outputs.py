"""The output files of ``fcm respond``; a checkpoint keeps the curves until these are written."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm import signals
from fcm.cli import fit, schedule, track
from fcm.cli.curves import as_table
from fcm.cli.files import alone, wrote
from fcm.cli.messages import Messages
from fcm.cli.terminal import plain

if TYPE_CHECKING:
    from fcm.response import Response
    from fcm.run import CheckpointFile


class Outputs:
    """Files that a run writes: netCDF, CSV of curves and of motion, exports; and a summary."""

    def __init__(
        self,
        messages: Messages,
        output: Path | None,
        csv: Path | None,
        history_csv: Path | None,
        exported: Sequence[tuple[Path, Callable[[Response, Path], None]]] = (),
    ) -> None:
        self.messages, self.output, self.csv, self.history_csv = messages, output, csv, history_csv
        self.exported = exported
        self.checkpoint: CheckpointFile | None = None
        self.written = False  # whether there is a file of this run

    @contextmanager
    def kept(self, resume: bool) -> Iterator[CheckpointFile | None]:
        """Context with a checkpoint beside the first file, until the files are written."""
        files = [path for path in (self.output, self.csv, self.history_csv) if path is not None]
        files += [path for path, _ in self.exported]
        if not files:
            yield None
            return
        anchor = files[0]
        from fcm.files import real, remove_stale
        from fcm.run import CheckpointFile
        from fcm.run.checkpoint_file import unfinished

        with ExitStack() as held:
            with signals.undisturbed():  # a signal cannot leave a created file behind
                self.checkpoint = held.enter_context(CheckpointFile(unfinished(anchor), resume))
            held.enter_context(alone(files[1:]))
            if resume and not self.checkpoint.resumable and not self.checkpoint.set_aside:
                self.messages.info(f"{plain(anchor)}: no unfinished run is kept: this one begins anew")
            remove_stale(real(anchor))
            try:
                yield self.checkpoint
            except BaseException as error:
                nothing = "nothing is finished, so nothing is kept" if signals.interrupted(error) else ""
                self._say_kept("what is finished is kept", nothing)
                raise

    def write(self, response: Response, to_json: bool) -> dict[str, Any]:
        """Write all files and print the summary; the curves are then no longer kept."""
        from fcm.results.curve_extracts import with_extracts
        from fcm.results.summary import summary

        response = replace(response, curves=[with_extracts(curve) for curve in response.curves])
        result = summary(response)
        try:
            for path, write in self._files(response):
                self._write(response, path, write)
        finally:  # the result is printed even if the disk is full
            text = json.dumps(result, indent=2, allow_nan=False) if to_json else _tables(result, response)
            click.echo(text)
        if response.interrupted:
            self._say_kept(
                "interrupted; what is finished is kept",
                "interrupted; no finished curve is kept, so --resume would begin anew"
                if self.checkpoint is not None
                else "interrupted; nothing is kept without -o FILE, with which --resume continues",
            )
        elif self.checkpoint is not None:
            for path in self.checkpoint.done():
                self.messages.info(f"removed {plain(path)}: all that it kept is written")
        return result

    def _files(self, response: Response) -> list[tuple[Path, Callable[[Response, Path], None]]]:
        if all(path is None for path in (self.output, self.csv, self.history_csv)):
            return list(self.exported)
        from fcm.results import output
        from fcm.results.csv_file import write_csv, write_tracked_csv

        table = write_csv if response.curves else schedule.write_csv
        if response.tracking is not None and not response.curves:
            table = write_tracked_csv
        files = (
            (self.output, output.write_netcdf),
            (self.csv, table),
            (self.history_csv, schedule.write_csv),
        )
        return [*((path, write) for path, write in files if path is not None), *self.exported]

    def _write(self, response: Response, path: Path, write: Callable[[Response, Path], None]) -> None:
        """Write a file; a partial result does not replace a finished one, or one with more points."""
        part = self.checkpoint if response.interrupted else None
        points = sum(curve.points for curve in response.curves)
        if part is not None and path.exists():
            before = part.written(path)
            if before is None or points < before:
                self.messages.info(
                    f"{plain(path)} is left as it was: an earlier run wrote more than this one, which was "
                    "interrupted. With another -o FILE both are kept"
                )
                return
        earlier = self.checkpoint is not None and self.checkpoint.written(path) is not None
        write(response, path)
        self.written = True
        if part is not None:
            part.wrote(path, points)
        self.messages.info(wrote(path, since_then=earlier))

    def _say_kept(self, what: str, nothing: str) -> None:
        """Warn where unfinished work is kept for --resume; without any, print `nothing`."""
        if self.checkpoint is not None and self.checkpoint.resumable:
            self.messages.warning(f"{what} in {plain(self.checkpoint.path)}: continue with --resume")
        elif nothing:
            self.messages.warning(nothing)


def _tables(result: dict[str, Any], response: Response) -> str:
    """The curves, then the phases of the schedule."""
    histories, unit = result.get("histories", []), response.frequency_unit
    found = "tracked" in result
    parts = [track.as_table(result, unit)] if found else []
    if "fitted" in result:
        parts, found = [fit.as_table(result)], True
    parts += [as_table(result, unit)] if result["curves"] or not (histories or found) else []
    return "\n\n".join([*parts, schedule.as_table(histories, unit)] if histories else parts)
