"""What cannot be drawn."""


class PlotError(ValueError):
    """The file is not what the picture needs, or does not hold what was asked for."""
