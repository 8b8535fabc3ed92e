"""The figures of theory and validation, computed and drawn: small SVG files whose lines have names.

usage: python -m tests.guide.figures [NAME...], which writes them into .github/guide/figures
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np

import fcm
from fcm.contact.contact_kernel import ContactParameters
from fcm.contact.plane.cycle import PlanarContact
from fcm.contact.plane.options import PlanarOptions
from fcm.plot.loop import STATES
from fcm.plot.style import house_style, new_figure

from .pages import GUIDE

FOLDER = GUIDE / "figures"
BLUE, ORANGE = "#0072b2", "#d55e00"  # apart for all eyes
TURN = np.linspace(0.0, 2.0 * np.pi, 721)


def drawn(axes, name, x, y, *args, **options):
    """A line that the test of the figures knows by its name."""
    (line,) = axes.plot(x, y, *args, **options)
    line.set_gid(name)


def contact_on_a_line(figure):
    """A loop with its states, beside what the three coefficients keep of it; the force between its limits."""
    values = 0.55, 0.7, 1.0
    loop, (f_b, f_s, f_c) = fcm.hysteresis_loop(*values), fcm.fourier_coefficients(*values)
    left, right = figure.subplots(1, 2)
    u, force, load = np.sin(TURN), loop.force(TURN), loop.normal_load(TURN)
    states = np.array(list(loop.states(TURN)))
    mean_and_first = f_b + f_s * np.sin(TURN) + f_c * np.cos(TURN)
    drawn(left, "harmonic", u, mean_and_first, "k--", lw=0.8, label="mean, first harmonic")
    for state, (name, look) in STATES.items():
        if np.any(states == state):
            left.plot(u, np.where(states == state, force, np.nan), label=name, **look)
            right.plot(TURN, np.where(states == state, force, np.nan), **look)
    drawn(right, "upper", TURN, load, "k:", lw=0.8, label="slip limits")
    drawn(right, "lower", TURN, -load, "k:", lw=0.8)
    left.set(xlabel="displacement  $u/a$", ylabel="friction  $f / (k_u a)$")
    right.set(xlabel=r"angle  $\theta$", xticks=[0, np.pi, 2 * np.pi], xticklabels=["0", "π", "2π"])
    right.set_ylabel("friction  $f / (k_u a)$")
    left.set_ylim(top=1.9)  # for its legend
    left.legend(loc="upper left", fontsize=7)
    right.legend(loc="upper center", fontsize=7)


def contact_in_a_plane(figure):
    """The path of the displacement and of the slider, with the disc that holds it at four instants."""
    loop = fcm.planar_loop([0, 1], [0, -0.6j], [0, 0.5j], mu=0.5, k_u=1.0, k_v=1.0, n_0=0.7)
    angles = np.linspace(0.0, 2.0 * np.pi, 361)
    u = np.array([np.cos(angles), 0.6 * np.sin(angles)])
    w, load = np.array(loop.slider(angles)), loop.normal_load(angles)
    w = w if w.shape[0] == 2 else w.T
    axes = figure.subplots()
    drawn(axes, "displacement", *u, "k-", lw=0.9, label="displacement  $u$")
    drawn(axes, "slider", *w, color=ORANGE, label="slider  $w$")
    for i in (20, 110, 200, 290):
        radius = 0.5 * load[i]
        axes.plot(u[0, i] + radius * np.cos(TURN), u[1, i] + radius * np.sin(TURN), color=BLUE, lw=0.5)
        axes.plot([w[0, i], u[0, i]], [w[1, i], u[1, i]], color=BLUE, lw=0.9, marker=".", ms=4)
    axes.set(xlabel="$x$", ylabel="$y$", aspect="equal")
    axes.legend(fontsize=7, loc="lower left")


def harmonic_balance(figure):
    """The response with one and three harmonics, and the exact one."""
    axes, scene = figure.subplots(), fcm.load_scene("yang1998-n5")
    for harmonics, style in ((1, ":"), (3, "--")):
        curve = fcm.respond(scene, harmonics=harmonics).isel(curve=0).sel(dof="u")
        drawn(
            axes, f"harmonics-{harmonics}", curve.frequency, curve.amplitude, style, color=ORANGE,
            label=f"{harmonics} harmonic{'s' * (harmonics > 1)}",
        )  # fmt: skip
    exact = fcm.respond(scene, method="exact").isel(curve=0).sel(dof="u")
    drawn(axes, "exact", exact.frequency, exact.amplitude, "k-", lw=0.8, label="exact motion")
    axes.set(xlabel="frequency [rad/s]", ylabel="amplitude", xlim=(1.1, 1.35), ylim=(-0.5, 16.5))
    axes.legend()


def continuation(figure):
    """The steps of a curve, and one of them: prediction by a parabola, correction normal to the tangent."""
    scene = fcm.load_scene("yang1998-n5")
    curve = fcm.respond(scene, harmonics=3).isel(curve=0).sel(dof="u")
    left, right = figure.subplots(1, 2)
    drawn(left, "points", curve.frequency, curve.amplitude, "k.-", lw=0.6, ms=2.5)
    left.set(xlabel="frequency [rad/s]", ylabel="amplitude", xlim=(1.1, 1.35))
    f, a = np.cos(np.linspace(-0.2, 2.4, 200)), np.linspace(-0.2, 2.4, 200)
    drawn(right, "curve", f, a, "k-", lw=0.8)
    places = np.array([0.0, 0.45, 0.9])  # of a curve that folds, f = cos a, a its unknown
    z = np.array([np.cos(places), places])
    tangent = np.array([-np.sin(places[2]), 1.0]) / np.hypot(np.sin(places[2]), 1.0)
    bend = np.array([-np.cos(places[2]), 0.0]) / (1.0 + np.sin(places[2]) ** 2)
    ahead = np.linspace(0.0, 0.9, 30)
    predicted = z[:, 2:] + tangent[:, None] * ahead + 0.5 * bend[:, None] * ahead**2
    normal = np.array([-tangent[1], tangent[0]])
    off = 0.0
    for _ in range(20):  # Newton's method in the line normal to the tangent
        at = predicted[:, -1] + off * normal
        off -= (at[0] - np.cos(at[1])) / (normal[0] + np.sin(at[1]) * normal[1])
    found = predicted[:, -1] + off * normal
    right.plot(*z, "k.", ms=6)
    drawn(right, "predictor", *predicted, color=BLUE, label="predictor")
    drawn(
        right, "corrector", [predicted[0, -1], found[0]], [predicted[1, -1], found[1]], color=ORANGE,
        marker=".", label="corrector",
    )  # fmt: skip
    right.set(xlabel=r"parameter  $\lambda$", ylabel="unknown  $x$", aspect="equal")
    right.legend(fontsize=7, loc="lower left")


def errors(figure):
    """The estimated errors of peaks beside the true ones, of the ten preloads of the paper's oscillator."""
    axes, scene = figure.subplots(), fcm.load_scene("yang1998")
    best = fcm.respond(scene, harmonics=21).peak_amplitude.sel(dof="u").values
    for harmonics, marker, colour in ((1, "o", ORANGE), (3, "s", BLUE)):
        found = fcm.respond(scene, harmonics=harmonics).sel(dof="u")
        true = abs(found.peak_amplitude.values / best - 1.0)[1:]  # but for that which is stuck, and linear
        drawn(
            axes, f"harmonics-{harmonics}", true, found.peak_error.values[1:], marker, ms=4, color=colour,
            label=f"{harmonics} harmonic{'s' * (harmonics > 1)}",
        )  # fmt: skip
    line = np.array([1e-5, 0.2])
    axes.plot(line, line, "k-", lw=0.6)
    axes.fill_between(line, 0.5 * line, 2.0 * line, color="0.9", lw=0)
    axes.set(xscale="log", yscale="log", xlabel="true error of a peak", ylabel="estimated error of a peak")
    axes.legend()


def exact_motion(figure):
    """The jump of figure 15 of the paper, cycle by cycle, simulated without a time step."""
    motion = fcm.respond(fcm.load_scene("yang1998-jump")).isel(curve=0).sel(dof="u")
    axes = figure.subplots()
    cycles = np.arange(1, motion.cycle_amplitude.size + 1)
    drawn(axes, "cycles", cycles, motion.cycle_amplitude.values, "k.", ms=2.5)
    for end, text in ((50, "1.195 rad/s"), (160, "1.190"), (235, "1.195")):
        axes.annotate(text, (end, 15.0), ha="center", fontsize=8)
    for border in (100, 220):
        axes.axvline(border, color="0.6", lw=0.6)
    axes.set(xlabel="cycles of the force", ylabel="amplitude", ylim=(0.0, 16.5))


def strip(count):
    """An elastic strip of springs and masses, pressed on the ground by contacts that share one preload."""
    from fcm.scene.load import scene_from_dict

    stiffness = np.zeros((2 * count, 2 * count))
    for i in range(count - 1):
        for off, spring in ((0, 100.0 * count), (count, 30.0 * count)):
            pair = np.ix_([i + off, i + 1 + off], [i + off, i + 1 + off])
            stiffness[pair] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness += np.diag([20.0 / count] * count + [50.0 / count] * count)
    dofs = [f"{direction}{i}" for direction in "uv" for i in range(count)]
    contacts = [
        {"name": f"c{i}", "tangential": f"u{i}", "normal": f"v{i}", "mu": 0.4, "k_u": 200.0 / count,
         "k_v": 300.0 / count, "n_0": 8.0 / count}
        for i in range(count)
    ]  # fmt: skip
    return scene_from_dict(
        {
            "structure": {"dofs": dofs, "mass": [1.0 / count] * (2 * count), "damping": 0.01,
                          "stiffness": stiffness.tolist(), "modes": 12},
            "contact": contacts,
            "force": [{"dof": f"u{count - 1}", "amplitude": 1.0}],
            "response": {"frequency": [10.0, 20.0], "harmonics": 1},
        }
    )  # fmt: skip


def many_contacts(figure):
    """Microslip of a strip on twenty contacts: how many slip along its response."""
    count = 20
    curve = fcm.respond(strip(count)).isel(curve=0).sel(dof=f"u{count - 1}")
    slipping = np.char.find(curve.regime.values.astype(str), "P") >= 0
    order = np.argsort(curve.frequency.values)
    upper, lower = figure.subplots(2, 1, sharex=True)
    drawn(upper, "amplitude", curve.frequency.values[order], curve.amplitude.values[order], "k-", lw=0.9)
    drawn(lower, "slipping", curve.frequency.values[order], slipping.sum(axis=-1)[order], "-", color=ORANGE)
    upper.set(ylabel="amplitude of the end")
    lower.set(xlabel="frequency [rad/s]", ylabel="contacts that slip")


def rubber(figure):
    """Frequency and damping of the first mode of RubBeR, seven harmonics; as published while it is stuck."""
    from ..published.test_rubber import STUCK, the_mode

    mode = the_mode()
    left, right = figure.subplots(1, 2)
    drawn(left, "frequency", mode.amplitude, mode.omega / (2.0 * np.pi), "k-", lw=0.9)
    left.axhline(STUCK, color=BLUE, lw=0.7, ls="--", label="published, stuck")
    left.legend(fontsize=7)
    drawn(right, "damping", mode.amplitude, 100.0 * mode.damping, "-", color=ORANGE, lw=0.9)
    left.set(xscale="log", xlabel="modal amplitude [m √kg]", ylabel="frequency [Hz]")
    right.set(xscale="log", xlabel="modal amplitude [m √kg]", ylabel="damping ratio [%]")


def den_hartog(figure):
    """Den Hartog's closed forms, with and without stops, and exact motions on a stiff contact."""
    from ..published.test_den_hartog import exact, with_stops, without_stops

    axes, high, low = figure.subplots(), np.linspace(0.54, 0.85, 60), np.linspace(0.47, 0.52, 12)
    drawn(axes, "without-stops", high, [without_stops(r) for r in high], "k-", lw=0.9, label="without stops")
    stops = [with_stops(r)[0] for r in low]
    drawn(axes, "with-stops", low, stops, "--", color=BLUE, lw=0.9, label="with stops")
    at = np.array([0.48, 0.5, 0.56, 0.6, 0.65, 0.7, 0.75, 0.8, 0.84])
    found = [exact(1e4, r) for r in at]
    drawn(axes, "exact", at, found, "+", color=ORANGE, label="exact motion")
    axes.set(xlabel="frequency over the natural one", ylabel="amplitude over the static one")
    axes.legend()


def two_masses(figure):
    """A chain of two masses, the first with rigid friction: marched with rigid friction, and fcm."""
    from ..published.test_two_masses import STEPS, marched, scene

    axes, at = figure.subplots(), np.array([0.4, 0.55, 0.68, 0.85, 1.2])
    amplitudes = np.array([marched(omega, STEPS // 2)[0] for omega in at])
    wide = replace(scene(0.8), frequency_range=(0.35, 1.3))
    curve = fcm.respond(wide, harmonics=[1, 3, 5, 7, 9]).isel(curve=0)
    for i, (name, colour) in enumerate((("first", ORANGE), ("last", BLUE))):
        drawn(
            axes, name, curve.frequency, curve.amplitude.isel(dof=i), "-", color=colour, lw=0.9,
            label=f"{name} mass, nine harmonics",
        )  # fmt: skip
        drawn(axes, f"{name}-marched", at, amplitudes[:, i], "k+", label="marched" if i else None)
    axes.set(xlabel="frequency", ylabel="amplitude")
    axes.legend()


ELLIPSE = {"u_x": [0, 1.0], "u_y": [0, -0.7j], "v": [0, 1.0]}  # which slips all the time
LAW = {"mu": 1.0, "k_u": 1.0, "k_v": 0.1, "n_0": 0.3}


def radial_return(samples, periods=30):
    """First coefficients of f_x and f_y of that ellipse: a trial, then back to the disc, sample by sample."""
    turn = np.exp(2j * np.pi * np.arange(samples) / samples)
    u = turn.real + 0.7j * turn.imag  # u_x + i u_y
    limit = LAW["mu"] * (LAW["n_0"] + LAW["k_v"] * turn.real)
    w, force = 0j, np.empty(samples, complex)
    for _ in range(periods if samples < 100 else 4):
        for i in range(samples):
            trial = u[i] - w
            force[i] = trial * min(1.0, limit[i] / max(abs(trial), 1e-300))
            w = u[i] - force[i]
    return 2.0 / samples * np.array([force.real @ turn.conj(), force.imag @ turn.conj()])


def sampled_slip(figure):
    """The force of a slip in a plane that never ends: error against the angles at which it is evaluated."""
    axes = figure.subplots()
    best = np.array([part[1] for part in fcm.planar_forces(**ELLIPSE, **LAW)[:2]])
    counts = 2 ** np.arange(5, 13)
    sampled = np.array([abs(radial_return(count) - best).max() for count in counts])
    panels, errors = np.array([5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.0]), []
    for length in 2.0 * np.pi / panels:
        options = PlanarOptions(
            tolerance=1.0, panel_length=2.0 * length, last_change=1e-8
        )  # no panel is longer
        contact = PlanarContact([1], [1], options=options)
        contact.at(np.array([0, 0, 0, 1.0, 0, 0, -0.7, 1.0, 0]), ContactParameters(**LAW), gradient=False)
        errors.append(abs(np.array(contact.forces)[3:7].view(complex) - best).max())
    for name, x, y, colour in (
        ("radial return", counts, sampled, ORANGE),
        ("panels, as here", 8 * panels, np.array(errors), BLUE),
    ):
        order = -np.polyfit(np.log(x), np.log(y), 1)[0]
        drawn(
            axes, name.split()[0].strip(","), x, y, "o-", ms=3, lw=0.9, color=colour,
            label=f"{name}: order {order:.1f}",
        )  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="angles of a cycle", ylabel="error of the force")
    axes.legend()


FIGURES = {
    "contact-on-a-line": (contact_on_a_line, 5.8, 2.6),
    "contact-in-a-plane": (contact_in_a_plane, 4.2, 3.0),
    "sampled-slip": (sampled_slip, 4.0, 2.8),
    "harmonic-balance": (harmonic_balance, 4.4, 2.8),
    "continuation": (continuation, 5.8, 2.6),
    "errors": (errors, 3.8, 3.0),
    "exact-motion": (exact_motion, 5.0, 2.6),
    "many-contacts": (many_contacts, 4.4, 3.4),
    "rubber": (rubber, 5.8, 2.4),
    "den-hartog": (den_hartog, 4.2, 2.8),
    "two-masses": (two_masses, 4.2, 2.8),
}


def write(name: str, folder: Path = FOLDER) -> Path:
    """Compute one figure, draw it and save it; texts remain texts."""
    draw, width, height = FIGURES[name]
    path = folder / f"{name}.svg"
    with house_style():
        mpl.rcParams.update({"svg.fonttype": "none", "path.simplify_threshold": 0.3})
        mpl.rcParams.update(
            {"font.family": ["DejaVu Sans"], "mathtext.fontset": "dejavusans", "font.size": 8}
        )
        figure = new_figure(width, height)
        draw(figure)
        figure.savefig(path, metadata={"Date": None, "Creator": None})
    return path


if __name__ == "__main__":
    for chosen in sys.argv[1:] or FIGURES:
        print(write(chosen))
