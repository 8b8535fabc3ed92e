"""Pictures of results, drawn from the files that the commands write; nothing is computed here."""

from fcm.plot.errors import PlotError
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
