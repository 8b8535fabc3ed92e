"""``python -m tests.report WHAT``: the page of a folder of results, or a picture with its numbers."""

from __future__ import annotations

import click

from fcm.cli.lazy import LazyGroup

PAGES = {
    "paper": ("tests.report.paper:paper", "The figures of the paper, and its numbers beside those obtained."),
    "evidence": ("tests.report.evidence:evidence", "Errors and run times of every method, and what failed."),
    "others": ("tests.report.others:others", "Other packages beside fcm."),
    "published": ("tests.report.published:published", "Published numbers beside those obtained."),
    "convergence": ("tests.report.convergence:convergence", "Error against run time with more harmonics."),
    "multipliers": ("tests.report.multipliers:multipliers_page", "Floquet multipliers, balanced and exact."),
    "kept-modes": ("tests.report.kept_modes:kept_modes", "Error of peaks against the number of kept modes."),
}


@click.group(cls=LazyGroup, lazy=PAGES)
def main() -> None:
    """Write index.html into a folder that `make` has filled, or measure what a picture of README.md shows."""


if __name__ == "__main__":
    main(prog_name="python -m tests.report")
