"""The look of every picture: type, widths, colours, and reproducible files."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure


DOTS = (0.0, (1.0, 1.0))  # line style where stability is unknown, or no steady state exists


class PictureLayout(Frozen):
    """Sizes of pictures, and how much is drawn in one."""

    width: float = 5.5  # [inch] 140 mm, one and a half columns
    height: float = 3.7  # [inch]
    dpi: int = 300  # dots per inch of a picture of dots
    decade: float = 10.0  # curves whose heights span more are drawn on a logarithmic axis
    column: float = 3.35  # [inch] 85 mm, one column of a journal
    height_with_errors: float = 4.9  # [inch] of a figure of a response with the panel of its errors
    row_height: float = 2.7  # [inch] of a row of panels
    pairs_height: float = 3.4  # [inch] of a row of panels with contacts
    direction_name: int = 30  # characters of a direction that fit beside an axis
    planar_height: float = 6.1  # [inch] of a planar loop and its forces
    normal_force_height: float = 4.6  # [inch] of a normal force over its motion and over a cycle
    loop_alone: float = 1.25  # height of a loop alone, relative to that of one in a row
    plane_alone: float = 1.4  # height of a picture of one panel, relative to that of a row of two
    band_opacity: float = 0.28  # of a band, so that bands of several curves show through
    doubtful_opacity: float = 0.3  # of a stretch of a curve whose error is large
    below_reference: float = 0.14  # room below the error of a reference for its name, of the decades above it
    doubtful_error: float = 0.2  # estimated error beyond which a curve is faded
    # relative width in frequency up to which a stretch without a known error counts as that of a fold
    fold_width: float = 1e-2
    headroom: float = 1.05  # of an axis, at least, above the highest amplitude
    campbell_top: float = 2.5  # modes are shown up to this multiple of the range's end
    campbell_headroom: float = 1.08  # above the highest mode that is shown
    campbell_harmonics: int = 5  # of an engine order that are marked, at most
    campbell_orders: int = 6  # that have a line each, at most
    campbell_bar: float = 0.018  # of the axis: width of the bar of an engine order
    campbell_filled: float = 0.75  # of the distance of two diameters, by bars beside one another
    campbell_labelled: float = 0.95  # of the axis: upper limit of the numbers of harmonics
    halo: float = 2.0  # [point] of white around a mark that stands on lines
    bar_names: int = 20  # with more lines than this, a colour bar names some of them
    bar_ticks: int = 9  # of a colour bar, at most
    bar_width: float = 7.0  # [point] of a colour bar beside maps, and of the gap to it
    dark: float = 0.1  # of the greatest value: columns that stay below are dark on a linear scale
    least_colour: float = 1e-4  # of the greatest value: smaller ones have no colour on a logarithmic scale
    line_places: int = 16  # places of a smooth line per piece between two points
    shortest_stretch: float = 2.5  # [point] of a dashed or faded line that a legend names
    fitted_of_row: int = 2  # numbers of a fit beside one another
    great_error: float = 0.05  # relative error of a peak above which it is written beside the peak
    meaning_letters: int = 80  # in a line of text that explains tracked curves
    same_end: float = 1e-6  # of the extent: two points of a curve nearer than this are one
    letters_of_inch: float = 20.0  # small letters per inch of a line above the axes
    lines_above: int = 3  # of text above the axes
    touch_roundings: float = 8.0  # roundings of a coordinate up to which the nodes of a pair coincide
    least_weight: float = 1e-9  # of an axis in the name of a direction; less is a rounding error
    name_leader: int = 10  # [point] a name this far from its peak has a thin line to it
    name_margin: float = 2.0  # [pixel] around a name, at 100 to the inch
    name_points: int = 12  # checks for contact with a name, per piece of a curve
    mark_directions: int = 16  # directions from a mark to its text that are tried
    mark_leader: float = 9.0  # [point] a text this far from its mark has a thin line to it
    mark_leader_points: int = 12  # points of that line that are checked for contact with a text
    mark_steep: float = 2.5  # slope of an offset beyond which the text is centred towards its mark
    tick: float = 3.5  # [point] length of the ticks inside the frame
    linear_error: float = 1e-12  # estimated errors below are rounding: the motion is linear there
    error_bins: int = 120  # over the frequencies
    error_lines: int = 6  # errors of more curves than this are one line, the greatest of all
    least_error: float = 1e-30  # drawn in the place of 0, far below the panel
    history_panels: int = 6  # one for each curve: more do not fit a page
    history_cycles: int = 60  # drawn as a line; more would be a solid area
    history_boundaries: int = 40  # lines between phases; more would be a solid area, too
    letter: float = 0.026  # width of a letter of a label with some space, relative to the axes
    interface_room: float = 0.06  # around the interface, as part of its greater extent
    few_contacts: int = 6  # most contacts in a row for a picture of one column
    named_contacts: int = 20  # most contacts in a plane that are named
    row_of_contacts: float = 5.6  # [inch] height of a picture of contacts on a line
    thickest_bar: float = 0.12  # of the axis: a bar of one contact in a row
    line_distance: float = 1.3  # of two lines of text, relative to its size
    letter_width: float = 0.55  # mean width of a letter, relative to the size of the text
    panels: int = 6  # points of an interface, or contacts, in a picture
    loop_columns: int = 4  # loops side by side
    small_text: int = 7  # [point] texts within a picture
    loop_room: float = 0.18  # beside a loop, relative to its extent
    loop_named: int = 60  # transitions whose angles still find room beside them
    loop_narrowest: float = 11.0  # [degree] a state shorter than this has no letter
    mistakes: int = 5  # mistakes of a file of places that are listed; the rest are counted
    same_circle: float = 0.99  # ratio of two radii from which only the greater circle is drawn
    planar_room: float = 0.56  # of the extent of a planar loop, to each side of the middle
    planar_samples: int = 1440  # of a cycle of a planar loop
    # of the motion in a plane: smaller displacements along a direction count as none. Displacements across a
    # contact are differences of greater ones, and have fewer digits
    planar_rest: float = 1e-9
    planar_instants: int = 4  # of a cycle at which the disc is drawn
    seen_end: float = 1e-2  # of the axis of a number: a line that ends further from both ends is explained
    short_track: float = (
        0.05  # of the axis of a number: a shorter low line does not make the other logarithmic
    )
    swept_span: float = 30.0  # positive swept values of a greater ratio are on a logarithmic axis
    narrow_scatter: float = 2.0  # ratio of drawn peaks below which their axis does not begin at 0
    scatter_room: float = 0.15  # then the room below and above the peaks, of their extent
    peak_lines: int = 12  # more combinations of the other swept values than this are a cloud of points
    marked_points: int = 60  # values or points on a line that are marked; with more, none or some are
    point_edge: float = 0.7  # [point] of a marked point
    wide_frequencies: float = 30.0  # ratio of frequencies from which their axis is logarithmic
    bars: int = 20  # of sensitivities, at most
    negligible_bar: float = 1e-3  # of the greatest: numbers that do less are not drawn
    surface_ticks: int = 5  # intervals of an axis in space, at most
    surface_levels: int = 12  # bands of filled contours, at most
    table_error: float = 1e-300  # replaces 0, which has no logarithm


LAYOUT = PictureLayout()

COLUMN, TWO_COLUMNS = 85.0 / 25.4, 170.0 / 25.4  # [inch] widths of a journal

STYLE: dict[Any, Any] = {
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "axes.formatter.useoffset": False,  # ticks show whole frequencies, not offsets
    "axes.linewidth": 0.6,
    "axes.unicode_minus": True,
    "font.family": ["STIXGeneral", "DejaVu Serif"],  # the second has characters that the first lacks
    "font.size": 9,
    "legend.fontsize": 8,
    "legend.title_fontsize": 8,
    "legend.frameon": False,
    "lines.solid_capstyle": "round",
    "mathtext.fontset": "stix",
    "pdf.fonttype": 42,
    "savefig.dpi": LAYOUT.dpi,
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
    """Set the look regardless of matplotlib's own configuration; characters that no font has are boxes."""
    import matplotlib

    with matplotlib.rc_context(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph .* missing from")  # see `lacking`
        logging.getLogger("matplotlib.mathtext").setLevel(logging.ERROR)  # which says the same of formulae
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(STYLE)
        yield


def new_figure(width: float = LAYOUT.width, height: float = LAYOUT.height) -> Figure:
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


def split(
    values: npt.NDArray[np.float64], apart: npt.NDArray[np.bool_]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Split a line into the values outside and inside the mask `apart`, each NaN elsewhere.

    The second part includes the neighbours of masked points.

    >>> here, there = split(np.arange(4.0), np.array([False, False, True, True]))
    >>> here.tolist(), there.tolist()
    ([0.0, 1.0, nan, nan], [nan, 1.0, 2.0, 3.0])
    """
    drawn = apart.copy()
    drawn[1:] |= apart[:-1]
    drawn[:-1] |= apart[1:]
    return np.where(apart, np.nan, values), np.where(drawn, values, np.nan)


def logarithmic_axis(axes: Axes) -> None:
    """A logarithmic amplitude axis with its ticks as plain numbers."""
    axes.set_yscale("log")
    plain_ticks(axes.yaxis, 1e3)


def swept_axis(axes: Axes, lowest: float, highest: float) -> None:
    """Make the axis of a number logarithmic, with plain ticks, if its two ends are far apart."""
    if highest > LAYOUT.swept_span * lowest > 0.0:
        axes.set_xscale("log")
        plain_ticks(axes.xaxis, 1e3)


def plain_ticks(axis: Axis, widest: float) -> None:
    """Write the ticks of a logarithmic axis as numbers: 0.5, 1, 2, 5, 10; beyond the ratio `widest` 1, 10.

    If numbers are small or great, all are written as powers, such as 5e-5 and 1e-4.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    def written(value: float, _position: object) -> str:
        least, most = (10.0**end for end in STYLE["axes.formatter.limits"])
        if least <= min(axis.get_view_interval()) and max(axis.get_view_interval()) < 10.0 * most:
            return f"{value:g}"
        digits, _, power = f"{value:.0e}".partition("e")
        return rf"${digits}\times10^{{{int(power)}}}$"

    low, high = sorted(axis.get_view_interval())
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < widest * low else (1,)))
    axis.set_major_formatter(FuncFormatter(written))
    axis.set_minor_formatter(NullFormatter())


def has_decades(heights: Sequence[float]) -> bool:
    """Whether heights differ so much that the lowest would lie at the foot of a linear axis."""
    return bool(max(heights) > LAYOUT.decade * min(heights) > 0.0)


def lacking(figure: Figure) -> str:
    """The characters of a figure's texts that none of the fonts has, each once."""
    from matplotlib.font_manager import FontProperties, findfont, get_font
    from matplotlib.text import Text

    texts = [one.get_text() for one in figure.findobj(Text)]
    fonts = [get_font(findfont(FontProperties(family=[name]))) for name in STYLE["font.family"]]
    found = sorted({letter for text in texts for letter in text if letter.isprintable()})
    return "".join(one for one in found if not any(font.get_char_index(ord(one)) for font in fonts))


def save(figure: Figure, path: Path, dpi: int = LAYOUT.dpi) -> None:
    """Write the picture in the format of its ending: the same bytes for the same figure.

    It is drawn in memory first: on a full disk, a PDF would fail with an error of its compression.
    """
    ending, drawn = path.suffix.lower(), BytesIO()
    with house_style():
        figure.savefig(drawn, dpi=dpi, format=ending[1:], metadata=_UNDATED[ending])
    path.write_bytes(drawn.getvalue())


def colour_bar(figure: Figure, names: Sequence[str], title: str) -> None:
    """Draw a colour bar of the lines in their order, with the names of some."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, ListedColormap

    count = len(names)
    each = BoundaryNorm(np.arange(count + 1) - 0.5, count)
    colours = ScalarMappable(each, ListedColormap(sequence_colours(count)))
    shown = np.unique(np.linspace(0, count - 1, LAYOUT.bar_ticks).round().astype(int)).tolist()
    bar = figure.colorbar(colours, ax=figure.axes, ticks=shown, pad=0.02)
    bar.ax.set_yticklabels([names[i] for i in shown])
    bar.ax.minorticks_off()
    bar.set_label(title)
