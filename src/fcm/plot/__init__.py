"""Pictures of results, drawn from the files that the commands write; nothing is computed here.

The names below are imported when first used: a command that only shortens names needs no pictures.
"""

from typing import TYPE_CHECKING

from fcm.lazy_import import on_demand
from fcm.plot.errors import PlotError

if TYPE_CHECKING:
    from fcm.plot.points import DrawnPoints, read_points
    from fcm.plot.read import DrawnCurve, DrawnResponse, read_response
    from fcm.plot.response import draw_response
    from fcm.plot.style import save

__all__ = [
    "DrawnCurve",
    "DrawnPoints",
    "DrawnResponse",
    "PlotError",
    "draw_response",
    "read_points",
    "read_response",
    "save",
]

_HOME = {
    "DrawnCurve": "read",
    "DrawnPoints": "points",
    "DrawnResponse": "read",
    "draw_response": "response",
    "read_points": "points",
    "read_response": "read",
    "save": "style",
}

__getattr__ = on_demand(__name__, _HOME)
