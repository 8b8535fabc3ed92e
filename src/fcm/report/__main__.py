"""``python -m fcm.report WHAT FOLDER``: the page of a folder of results."""

from __future__ import annotations

import click

from fcm.cli.lazy import LazyGroup

PAGES = {
    "paper": ("fcm.report.paper:paper", "The figures of the paper, and its numbers beside those obtained."),
    "accuracy": ("fcm.report.accuracy:accuracy", "Error against run time of some scenes."),
}


@click.group(cls=LazyGroup, lazy=PAGES)
def main() -> None:
    """Write index.html into a folder that `make` has filled with pictures and results."""


if __name__ == "__main__":
    main(prog_name="python -m fcm.report")
