"""A mistuned ring in pictures: the envelope over its sectors, and the amplification of its worst blade."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from fcm.frozen import Frozen
from fcm.plot.style import DOTS, LAYOUT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from fcm.plot.read import DrawnResponse

FloatArray = npt.NDArray[np.float64]
ENVELOPE = "envelope"
_OF_CURVE = (
    "worst_amplitude",
    "worst_frequency",
    "worst_sector",
    "tuned_amplitude",
    "tuned_frequency",
    "amplification",
)
_ENDS = ("worst_at_end", "tuned_at_end")
NEEDED = ("sector_dof", "stiffness_factor", *_OF_CURVE, *_ENDS)
ALSO = (ENVELOPE, *NEEDED)  # read where they are there
TUNED = "peak of the tuned ring"
RATIO = "amplification: greatest peak over the tuned ring's"
EACH = "each sector"
TUNED_LOOK: dict[str, Any] = {
    "marker": "D",
    "markersize": 4.5,
    "markerfacecolor": "white",
    "linestyle": "none",
}
_GREY, _NOTE = "0.7", "#c03020"


class DrawnBlades(Frozen):
    """Data of a mistuned ring beside its curves, in the file's units.

    The arrays are (curve, dof), for the degrees of freedom of a sector.
    """

    names: tuple[str, ...]  # degrees of freedom of a sector
    sectors: int
    amplitude: FloatArray  # greatest of all sectors and points
    frequency: FloatArray
    sector: FloatArray  # counted from 0
    tuned: FloatArray  # peak of the tuned ring, NaN where that is not known
    tuned_frequency: FloatArray
    amplification: FloatArray  # NaN where it is not known
    at_end: FloatArray  # 1 where the amplitude is at an end of the range, and no peak
    tuned_at_end: FloatArray

    def place(self, dofs: Sequence[str], column: int) -> int | None:
        """Index into `names` of a column; None if the column is of one sector.

        The last columns of `dofs` are those of `names`.
        """
        place = column - (len(dofs) - len(self.names))
        return place if place >= 0 else None

    def asked(self, dofs: Sequence[str]) -> tuple[str, ...]:
        """Names that the scene asks for in any sector; `dofs` is all that it asks for."""
        return tuple(name for name in self.names if any(self._is_of(name, dof) for dof in dofs))

    def _is_of(self, name: str, dof: str) -> bool:
        from fcm.model.ring import of_sector

        return any(dof == of_sector(name, k) for k in range(self.sectors))

    def columns(self, dofs: Sequence[str], place: int) -> npt.NDArray[np.intp]:
        """Columns of a degree of freedom in each sector that the file has."""
        from fcm.model.ring import of_sector

        each = [of_sector(self.names[place], k) for k in range(self.sectors)]
        return np.array([dofs.index(name) for name in each if name in dofs], dtype=np.intp)

    def tuned_peaks(self, place: int) -> tuple[FloatArray, FloatArray]:
        """Frequencies and amplitudes (curve,) of the tuned ring's peaks; NaN where the range has none."""
        peak = self.tuned_at_end[:, place] != 1.0
        of = (self.tuned_frequency, self.tuned)
        at, height = (np.where(peak, values[:, place], np.nan) for values in of)
        return at, height

    def label(self, curve: int, place: int) -> str:
        """The amplification of a curve and the sector it is in; empty where it is not known.

        A greatest amplitude at an end of the range is no peak. If one of the two amplitudes is there, the
        amplification is a bound; if both are, it is unknown.
        """
        ratio = float(self.amplification[curve, place])
        ends = bool(self.at_end[curve, place]), bool(self.tuned_at_end[curve, place])
        if not np.isfinite(ratio) or all(ends):
            return ""
        bound = "at least " * ends[0] + "at most " * ends[1]
        return f"amplification {bound}{ratio:.3f}, sector {self.sector[curve, place]:.0f}"

    def amplitude_label(self, place: int) -> str:
        return f"Greatest amplitude of {self.names[place]} in {self.sectors} sectors"

    def labels(self, place: int | None, curves: Sequence[int]) -> list[str]:
        """The `label` of each curve; empty if the column is no envelope (place None)."""
        return ["" if place is None else self.label(curve, place) for curve in curves]


def blades_of(variables: Mapping[str, Any]) -> DrawnBlades | None:
    """Read the blades from the variables of an open file; None if it holds no mistuned ring."""
    if not all(name in variables for name in NEEDED):
        return None
    from fcm.plot.read import floats

    names = tuple(str(name) for name in np.atleast_1d(variables["sector_dof"][:]))
    sectors = int(variables["stiffness_factor"].shape[1])
    return DrawnBlades(names, sectors, *(floats(variables[name]) for name in (*_OF_CURVE, *_ENDS)))


def draw_blades(
    axes: Axes, response: DrawnResponse, place: int, numbers: Sequence[int], colours: Sequence[str]
) -> dict[str, Line2D]:
    """Draw a diamond at the tuned ring's peak for each curve; for a single curve, also its sectors' lines.

    Returns the legend handles by their names.
    """
    from matplotlib.lines import Line2D

    blades, notes = response.blades, dict[str, Line2D]()
    assert blades is not None
    if len(numbers) == 1:
        curve = response.curves[numbers[0]]
        for column in blades.columns(response.own_dofs, place).tolist():
            axes.plot(
                curve.frequency, curve.amplitude[:, column], color=_GREY, linewidth=0.5, zorder=1,
                label=f"_{EACH}",
            )  # fmt: skip
        notes[EACH] = Line2D([], [], color=_GREY, linewidth=0.5)
    tuned = np.transpose(blades.tuned_peaks(place))
    peaks = {
        tuple(tuned[number].tolist()): colour
        for number, colour in zip(numbers, colours, strict=True)
        if np.isfinite(tuned[number]).all()
    }
    for (at, height), colour in peaks.items():
        own = "black" if len(peaks) == 1 else colour
        axes.plot([at], [height], color=own, zorder=4, label=f"_{TUNED}", **TUNED_LOOK)
    if peaks:
        notes[TUNED] = Line2D([], [], color="black", **TUNED_LOOK)
    if any(blades.labels(place, numbers)):
        notes[RATIO] = Line2D([], [], linestyle="none")
    return notes


def draw_tuned_peaks(figure: Figure, axes: Axes, blades: DrawnBlades, place: int, swept: FloatArray) -> None:
    """Draw the tuned ring's peaks beside those of the worst blades: diamonds, or a line if all are equal."""
    heights = blades.tuned_peaks(place)[1]
    known = np.isfinite(heights)
    if not known.any():
        return
    if np.unique(heights[known]).size == 1:
        line = axes.axhline(float(heights[known][0]), color="black", linewidth=0.7, linestyle=DOTS)
    else:
        (line,) = axes.plot(swept[known], heights[known], color="black", **TUNED_LOOK)
    axes.set_ylim(top=max(axes.get_ylim()[1], LAYOUT.headroom * float(heights[known].max())))
    figure.legend([line], [TUNED], loc="outside lower center")


def name_amplification(axes: Axes, blades: DrawnBlades, place: int) -> FloatArray:
    """Label a panel of amplifications and return these (curve,); NaN where they are only bounds."""
    axes.set_ylabel("Amplification (–)")
    bound = (blades.at_end[:, place] == 1.0) | (blades.tuned_at_end[:, place] == 1.0)
    if bound.any():
        said = f"left out: {int(bound.sum())} of {bound.size}, of greatest amplitudes at an end of the range"
        axes.set_title(said, loc="right", fontsize=8, color=_NOTE)
    return np.where(bound, np.nan, blades.amplification[:, place])
