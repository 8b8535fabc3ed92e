"""What was measured for a page: its numbers as a file, and their picture."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fcm.files import replacing
from fcm.plot.style import save

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150  # of a page that is read on a screen


def write_measured(output: Path, rows: Sequence[Any], picture: Path, figure: Figure) -> None:
    """The rows, which are dataclasses, as JSON, and the figure beside them."""
    with replacing(output) as partial_file:
        partial_file.write_text(json.dumps([asdict(row) for row in rows], indent=1), encoding="utf-8")
    with replacing(picture) as partial_file:
        save(figure, partial_file, dpi=DPI)
