"""Interactive pages of a response: every curve, numbers on hover, zoom, a menu of degrees of freedom.

plotly writes each page as one HTML file that needs no network.
"""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from fcm.plot.errors import PlotError
from fcm.plot.interface import CONTACT_LOADS, STATES_OF_CONTACTS, InterfaceFile, InterfacePoint, place_of
from fcm.plot.labels import short_names, with_unit
from fcm.plot.peak import Peaks
from fcm.plot.read import LEVEL, BoolArray, DrawnCurve, DrawnResponse, FloatArray, wide
from fcm.plot.style import LAYOUT, has_decades, sequence_colours
from fcm.plot.unfinished import sentence

STATES = ("stable", "unstable", "stability unknown")
DASHES = dict(zip(STATES, ("solid", "dash", "dot"), strict=True))


def response_page(response: DrawnResponse, dof: str | None, log: bool | None, path: Path) -> None:
    """Write the page of a response.

    Parameters
    ----------
    dof : str, optional
        The degree of freedom that is shown first; a menu has the others.
    log : bool, optional
        Whether the axis of the amplitude is logarithmic; by default if the peaks span more than a decade.
    path : Path
        Where the page goes; its picture is one trace for each curve and state of stability.
    """
    curves = [curve for curve in response.curves if np.isfinite(curve.amplitude).any()]
    if not curves:
        raise PlotError("the file holds no point of any curve")
    column, go = response.column(dof), _plotly()
    figure, parts = go.Figure(), list(_parts(curves))
    colours = dict(zip(map(id, curves), sequence_colours(len(curves)), strict=True))
    for curve, state, rows, first in parts:
        name, y = _name(curve, response), _masked(curve, rows, column)
        figure.add_scatter(
            x=curve.frequency, y=y, mode=_mode(y), name=name,
            legendgroup=name, showlegend=first, customdata=_said(curve, state),
            line={"color": colours[id(curve)], "dash": DASHES[state], "width": 1.5, "simplify": False},
            marker={"size": 4},
            hovertemplate="%{x:.6g}: <b>%{y:.6g}</b>, %{customdata[1]}, error %{customdata[0]}",
        )  # fmt: skip
    heights = [float(np.nanmax(curve.amplitude[:, column])) for curve in curves]
    along = "log" if wide(curves) and response.frequency_unit != LEVEL else "linear"
    up = "log" if (has_decades(heights) if log is None else log) else "linear"
    figure.update_xaxes(title=_frequency(response.frequency_unit), type=along)
    figure.update_yaxes(title=response.amplitude_label(column), type=up)
    said = [f"{dash}: {state}" for state, dash in DASHES.items() if any(state == part[1] for part in parts)]
    said += filter(None, [html.escape(sentence(response.unfinished))])
    title = {"text": "; ".join(said), "font": {"size": 13}, "x": 0.5}
    figure.update_layout(updatemenus=_menu(response, parts, column), title=title, **_LAYOUT)
    _write(figure, path)


def peak_page(peaks: Peaks, dof: str | None, against: str | None, path: Path) -> None:
    """Write the page of peaks against what was swept: one trace for each degree of freedom."""
    from fcm.plot.dof import column_of

    keys = list(peaks.parameters)
    if not keys:
        raise PlotError("nothing was swept: the file holds one curve, and one peak. Give the scene a [sweep]")
    if against is not None and against not in keys:
        from fcm.scene.errors import choices, quoted

        raise PlotError(f"{quoted(against)} was not swept; the file has {choices(keys)}")
    key, shown, figure = against or keys[0], column_of(peaks.dofs, dof), _plotly().Figure()
    order = np.argsort(peaks.parameters[key], kind="stable")
    for number, name in enumerate(peaks.dofs):
        states = _states_of_peaks(peaks, number, order)
        figure.add_scatter(
            x=peaks.parameters[key][order], y=peaks.amplitude[order, number], name=name,
            mode="markers" if peaks.random else "lines+markers",
            visible=True if number == shown else "legendonly",
            customdata=np.stack((peaks.frequency[order, number].astype(str), states), axis=1),
            hovertemplate="%{x:.6g}: <b>%{y:.6g}</b> at %{customdata[0]}, %{customdata[1]}",
        )  # fmt: skip
    figure.update_xaxes(title=with_unit(short_names(keys)[key], peaks.units.get(key, "")))
    figure.update_yaxes(title=with_unit("Peak amplitude", peaks.length))
    figure.update_layout(**_LAYOUT)
    _write(figure, path)


def contacts_page(
    file: InterfaceFile,
    points: Sequence[InterfacePoint],
    places: FloatArray | None,
    path: Path,
    axes: tuple[str, str] = InterfaceFile.axes,
) -> None:
    """Write the page of contacts at points of a curve.

    One menu selects the frequency, another the contact load. Hovering shows a contact's state and loads.

    Parameters
    ----------
    places : ndarray, optional
        Coordinates (contact, 2) of the contacts, whose colours show the load. None: heights show it.
    axes : tuple of str
        Names of the two coordinates.
    """
    go = _plotly()
    figure, names = go.Figure(), np.array(file.contacts)
    heads = [
        with_unit(f"{name[:1].upper()}{name[1:]}", file.units[k]) for k, (_, name) in enumerate(CONTACT_LOADS)
    ]
    number = np.arange(1, len(names) + 1)
    tops = [
        float(np.nanmax([one.contact_loads[k] for one in points], initial=0.0)) or 1.0
        for k in range(len(CONTACT_LOADS))
    ]
    for i, one in enumerate(points):
        states = np.array([STATES_OF_CONTACTS[k][0] for k in one.state])
        symbols = [_SYMBOLS[k] for k in one.state]
        x, y = (number, one.contact_loads[0]) if places is None else places.T
        figure.add_scatter(
            x=x, y=y, mode="markers", name=place_of(file, one), visible=i == 0,
            customdata=np.column_stack((names, states, *one.contact_loads[:3].astype(str))),
            marker={"symbol": symbols, "size": 10, "line": {"color": "black", "width": 0.5},
                    "color": one.contact_loads[0], "colorscale": "Viridis", "cmin": 0.0, "cmax": tops[0],
                    "showscale": places is not None},
            hovertemplate="<b>%{customdata[0]}</b>: %{customdata[1]}"
            + "".join(f"<br>{head}: %{{customdata[{2 + k}]:.6g}}" for k, head in enumerate(heads))
            + "<extra></extra>",
        )  # fmt: skip
    if places is None:
        named = {"tickvals": number, "ticktext": names} if len(names) <= LAYOUT.named_contacts else {}
        figure.update_xaxes(title="Contact", **named)
        figure.update_yaxes(title=heads[0])
    else:
        figure.update_xaxes(title=with_unit(axes[0], file.units[1]))
        figure.update_yaxes(title=with_unit(axes[1], file.units[1]), scaleanchor="x")
    shown = [_of_contacts(points, k, head, tops[k], places is None) for k, head in enumerate(heads)]
    frequencies = [
        {
            "label": f"{one.curve} {place_of(file, one)}{_doubt(one.stable)}{_beside(one.asked)}".strip(),
            "method": "restyle",
            "args": [{"visible": [j == i for j in range(len(points))]}],
        }
        for i, one in enumerate(points)
    ]
    place = {"xanchor": "left", "y": 1.12, "yanchor": "top", "direction": "down"}
    menus = [{"buttons": shown, "x": 0.0, **place}, {"buttons": frequencies, "x": 0.4, **place}]
    kinds = dict.fromkeys(int(k) for one in points for k in one.state)
    marks = "; ".join(f"{_SYMBOLS[k]}: {STATES_OF_CONTACTS[k][0]}" for k in sorted(kinds))
    title = {"text": marks, "font": {"size": 13}, "x": 0.7}
    figure.update_layout(updatemenus=menus, title=title, showlegend=False, **_LAYOUT)
    _write(figure, path)


_SYMBOLS = ("circle", "triangle-up", "square", "circle-open")  # by state, as in `STATES_OF_CONTACTS`


def _of_contacts(
    points: Sequence[InterfacePoint], k: int, head: str, top: float, heights: bool
) -> dict[str, Any]:
    """The button that shows contact load `k`, by heights or colours."""
    values = [one.contact_loads[k] for one in points]
    change: dict[str, Any] = {"marker.color": values, "marker.cmax": top}
    change |= {"y": values} if heights else {}
    layout = {"yaxis.title.text": head} if heights else {}
    return {"label": head, "method": "update", "args": [change, layout]}


def _doubt(stable: float) -> str:
    return "" if stable == 1.0 else ", unstable" if stable == 0.0 else f", {STATES[2]}"


def _beside(asked: str) -> str:
    return f", {asked}" if asked else ""


_LAYOUT: dict[str, Any] = {"template": "simple_white", "hovermode": "closest", "margin": {"t": 60, "r": 20}}


def _plotly() -> Any:
    try:
        from plotly import graph_objects
    except ModuleNotFoundError:
        raise PlotError(
            "a page needs the package plotly: pip install plotly, or write .png, .svg or .pdf"
        ) from None
    return graph_objects


def _write(figure: Any, path: Path) -> None:
    text = figure.to_html(include_plotlyjs=True, full_html=True, default_height="95vh")
    path.write_text(text, encoding="utf-8")


def _parts(curves: Sequence[DrawnCurve]) -> Iterator[tuple[DrawnCurve, str, BoolArray, bool]]:
    """Yield curve, state of stability, mask of its points, and whether this part is the curve's first."""
    for curve in curves:
        there = np.isfinite(curve.frequency)
        unstable = np.zeros_like(there) if curve.stable is None else ~curve.stable
        unknown = np.zeros_like(there) if curve.unknown is None else curve.unknown
        every = zip(STATES, (~unstable & ~unknown, unstable & ~unknown, unknown), strict=True)
        found = [(state, rows & there) for state, rows in every if (rows & there).any()]
        for number, (state, rows) in enumerate(found):
            yield curve, state, rows, number == 0


def _masked(curve: DrawnCurve, rows: BoolArray, column: int) -> FloatArray:
    """The amplitude at the points of `rows` and those after them, so that parts meet; NaN elsewhere."""
    drawn = rows.copy()
    drawn[1:] |= rows[:-1]
    return np.where(drawn, curve.amplitude[:, column], np.nan)


def _mode(y: FloatArray) -> str:
    """Mode of a plotly trace: lines, with marks if a point stands alone, as in files of peaks alone."""
    there = np.concatenate(([False], np.isfinite(y), [False]))
    alone = there[1:-1] & ~there[:-2] & ~there[2:]
    return "lines+markers" if alone.any() else "lines"


def _said(curve: DrawnCurve, state: str) -> Any:
    """Text shown at each point beside its place: error, stability, and branch."""
    error = curve.truncation_error
    told = np.full(len(curve.frequency), np.nan) if error is None else error
    shown = ["unknown" if np.isnan(one) else f"{one:.1e}" for one in told]
    branch = 1 + np.cumsum(np.isnan(curve.frequency))
    several = branch.size and branch[-1] > 1
    which = [f"{state}, branch {number}" if several else state for number in branch.tolist()]
    return np.stack((np.array(shown), np.array(which)), axis=1)


def _name(curve: DrawnCurve, response: DrawnResponse) -> str:
    names = short_names(curve.parameters)
    each = ((names[key], value, response.units.get(key, "")) for key, value in curve.parameters.items())
    return ", ".join(f"{name} = {value:.4g} {unit}".rstrip() for name, value, unit in each) or "response"


def _frequency(unit: str) -> str:
    return "Level of the forces" if unit == LEVEL else f"Frequency ({unit})"


def _menu(response: DrawnResponse, parts: Sequence[Any], column: int) -> list[Mapping[str, Any]]:
    """A menu of the degrees of freedom; none where there is one."""
    if len(response.dofs) < 2:
        return []
    buttons = []
    for number, name in enumerate(response.dofs):
        change = {"y": [_masked(curve, rows, number) for curve, _, rows, _ in parts]}
        title = {"yaxis.title.text": response.amplitude_label(number)}
        buttons.append({"label": name, "method": "update", "args": [change, title]})
    place = {"x": 0.0, "xanchor": "left", "y": 1.12, "yanchor": "top"}
    return [{"buttons": buttons, "active": column, "direction": "down", **place}]


def _states_of_peaks(peaks: Peaks, column: int, order: Any) -> Any:
    if peaks.stable is None:
        return np.full(len(order), STATES[2])
    stable = peaks.stable[order, column]
    return np.where(np.isnan(stable), STATES[2], np.where(stable == 0.0, STATES[1], STATES[0]))
