"""The commands of ``fcm``, each imported only when it is called."""

from __future__ import annotations

import os

import click

import fcm
from fcm.cli.lazy import LazyGroup
from fcm.threads import one_by_default

one_by_default()
os.environ["MPLBACKEND"] = "agg"  # pictures are written to files, never shown

COMMANDS = {
    "respond": ("fcm.cli.respond:respond", "Trace the response curves of a scene."),
    "plot": ("fcm.cli.plot:plot", "Draw a result, or the coefficients of one contact."),
    "tabulate": ("fcm.cli.tabulate:tabulate", "Build a table of the Fourier coefficients of friction."),
}

INSTEAD = {  # for commands that do not exist: the one that does the task
    "fit": "fcm respond SCENE, with a table [fit] in the scene",
    "optimum": "fcm respond SCENE, with a table [optimum] in the scene",
    "sweep": "fcm respond SCENE, with a table [sweep] in the scene",
    "schedule": "fcm respond SCENE, with tables [[schedule]] in the scene",
    "mode": "fcm respond SCENE --mode N --level FROM:TO",
    "level": "fcm respond SCENE --level FROM:TO --at F",
    "track": "fcm respond SCENE --track WHAT --over KEY --from X --to X",
    "export": "fcm respond SCENE --export FILE",
    "compare": "fcm respond SCENE --compare",
    "modes": "fcm plot modes SCENE",
}


@click.group(
    cls=LazyGroup,
    lazy=COMMANDS,
    instead=INSTEAD,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Exit codes: 0 done; 2 the input is wrong; 3 the calculation could not be completed; "
    "1 a defect of fcm.",
)
@click.version_option(fcm.__version__, "-V", "--version", message="%(prog)s %(version)s")
def main() -> None:
    """Vibration of structures with friction contacts that stick, slip and open."""
