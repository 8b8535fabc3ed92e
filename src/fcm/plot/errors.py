"""Error raised for what cannot be drawn."""


class PlotError(ValueError):
    """Raised when a file is not what the picture needs, or does not hold what was asked for."""
