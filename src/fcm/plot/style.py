"""The look of every picture: type, widths, colours, and files that come out the same each time."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

WIDTH = 5.5  # [inch] 140 mm, one and a half columns
HEIGHT = 3.7  # [inch]
DPI = 300
_DECADE = 10.0  # curves whose heights span more are drawn on a logarithmic axis
COLUMN, TWO_COLUMNS = 85.0 / 25.4, 170.0 / 25.4  # [inch] widths of a journal

STYLE: dict[Any, Any] = {
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "axes.formatter.useoffset": False,  # a frequency is read from its tick, not from a sum
    "axes.linewidth": 0.6,
    "axes.unicode_minus": True,
    "font.family": ["STIXGeneral", "DejaVu Serif"],  # a character that the first lacks is of the second
    "font.size": 9,
    "legend.fontsize": 8,
    "legend.title_fontsize": 8,
    "legend.frameon": False,
    "lines.solid_capstyle": "round",
    "mathtext.fontset": "stix",
    "pdf.fonttype": 42,
    "savefig.dpi": DPI,
    "svg.fonttype": "path",
    "svg.hashsalt": "fcm",
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
}

_UNDATED = {
    ".png": {"Software": None},
    ".svg": {"Date": None, "Creator": None},
    ".pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}


@contextmanager
def house_style() -> Iterator[None]:
    """The look, whatever matplotlib's own configuration says; characters that no font has are boxes."""
    import matplotlib

    with matplotlib.rc_context(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")  # see `lacking`
        logging.getLogger("matplotlib.mathtext").setLevel(logging.ERROR)  # which says the same of formulae
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        yield


def new_figure(width: float = WIDTH, height: float = HEIGHT) -> Figure:
    """A figure that needs no display; use within ``house_style()``."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def sequence_colours(count: int) -> list[str]:
    """Colours in an order that survives colour blindness and a grey print, dark to light."""
    import matplotlib
    from matplotlib.colors import to_hex

    if count == 1:
        return ["#000000"]
    return [to_hex(colour) for colour in matplotlib.colormaps["viridis"](np.linspace(0.0, 0.8, count))]


def logarithmic_axis(axes: Axes) -> None:
    """A logarithmic amplitude axis with its ticks as plain numbers."""
    axes.set_yscale("log")
    plain_ticks(axes.yaxis, 1e3)


def plain_ticks(axis: Axis, widest: float) -> None:
    """Ticks of a logarithmic axis as numbers: 0.5, 1, 2, 5, 10; where its ends have a greater ratio 1, 10."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    low, high = sorted(axis.get_view_interval())
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < widest * low else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _position: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def has_decades(heights: Sequence[float]) -> bool:
    """Whether they differ so much that on a linear axis the lowest would lie on its foot."""
    return bool(max(heights) > _DECADE * min(heights) > 0.0)


def lacking(figure: Figure) -> str:
    """The characters of a figure's texts that none of the fonts has, each once."""
    from matplotlib.font_manager import FontProperties, findfont, get_font
    from matplotlib.text import Text

    texts = [one.get_text() for one in figure.findobj(Text)]
    fonts = [get_font(findfont(FontProperties(family=[name]))) for name in STYLE["font.family"]]
    found = sorted({letter for text in texts for letter in text if letter.isprintable()})
    return "".join(one for one in found if not any(font.get_char_index(ord(one)) for font in fonts))


def save(figure: Figure, path: Path, dpi: int = DPI) -> None:
    """Write the picture in the format of its ending: the same bytes for the same figure.

    Drawn in memory first: on a full disk, a PDF would end by what its compression says of itself.
    """
    ending, drawn = path.suffix.lower(), BytesIO()
    with house_style():
        figure.savefig(drawn, dpi=dpi, format=ending[1:], metadata=_UNDATED[ending])
    path.write_bytes(drawn.getvalue())
