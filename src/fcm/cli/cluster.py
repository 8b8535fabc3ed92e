"""``--cluster ADDRESS``: a sweep on the workers of a `dask.distributed` scheduler."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from fcm.run import Factory
    from fcm.run.options import RunOptions


def check_options(address: str | None, level: object) -> None:
    """A usage error if there are options beside it that have no meaning then."""
    if address is None:
        return
    if level is not None:
        raise click.UsageError(
            "--cluster is of no use with --level, whose curves are followed in this process."
        )
    given = click.get_current_context().get_parameter_source("jobs")
    if given is click.core.ParameterSource.COMMANDLINE:
        raise click.UsageError("--jobs is of no use with --cluster, whose workers are as many as it has.")


def place_of(address: str | None, options: RunOptions | None) -> AbstractContextManager[Factory | None]:
    """Where to compute: on that cluster, as long as it is open; None for this machine."""
    if address is None:
        return nullcontext()
    from fcm.run.cluster import connected

    return connected(address) if options is None else connected(address, options)
