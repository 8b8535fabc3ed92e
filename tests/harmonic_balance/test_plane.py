"""Responses of contacts that slide in a plane, against closed forms, marches in time, and those on a line."""

from __future__ import annotations

import csv
import tomllib
from dataclasses import replace
from importlib.resources import files
from math import pi, sqrt
from types import SimpleNamespace

import numpy as np
import pytest

import fcm
from fcm.branches.force_level import solutions
from fcm.branches.trace import traced
from fcm.contact.kernels import periodic_contact, planar_contact
from fcm.continuation import Mark, Status
from fcm.harmonic_balance.contact_law import laws_in_a_plane, laws_on_a_line
from fcm.harmonic_balance.reported_quantities import reported_at
from fcm.harmonic_balance.system import System
from fcm.response import ResponseError
from fcm.response.exact import trace_exact
from fcm.response.level import LevelRequest, trace_levels
from fcm.response.mode import ModeRequest, trace_modes
from fcm.response.track import TrackRequest, track
from fcm.results.csv_file import write_csv
from fcm.scene import scene_from_dict
from fcm.stability.floquet import multipliers
from fcm.tracking.onset_functions import onset

from .plane_march import Oscillators

ALIKE, FEW = (1.0, 1.0, 2.0), (0.05, 0.05, 0.3)
QUARTER = pi / 2
CIRCLE = Oscillators(ALIKE, FEW, (1.0, 1.0, 0.0), (0.0, QUARTER, 0.0), 0.5, 1.0, 0.0, 1.0)
OBLIQUE = replace(CIRCLE, lag=(0.0, 0.0, 0.0))
ELLIPSE = Oscillators((1.0, 1.3, 2.0), FEW, (1.0, 0.6, 0.5), (0.0, 1.0, 0.4), 0.5, 1.0, 1.0, 1.0)
OPENS = replace(ELLIPSE, force=(1.0, 0.6, 2.0), n_0=0.3)


def single(name, **more):
    """A bundled scene without its sweep, as a dict."""
    data = tomllib.loads((files("fcm") / "scenes" / f"{name}.toml").read_text(encoding="utf-8"))
    return {key: value for key, value in data.items() if key not in ("sweep", "schedule")} | more


def with_still(data):
    """The same with contacts in a plane, in whose second direction nothing moves."""
    modal = data["modal"] | {
        "dofs": [*data["modal"]["dofs"], "still"],
        "shapes": [[*row, 0.0] for row in data["modal"]["shapes"]],
    }
    contacts = [one | {"tangential": [one["tangential"], "still"]} for one in data["contact"]]
    return data | {"modal": modal, "contact": contacts}


def amplitudes(scene, omega, harmonics):
    """Half the peak-to-peak of the one solution at a frequency."""
    system = System(scene, tuple(range(1, harmonics + 1)))
    z = solutions(system, omega).solutions[0]
    return system, z, reported_at(system, z[None], np.zeros((1, z.size))).amplitude[0]


@pytest.mark.slow
def test_a_mass_driven_in_a_circle():
    """One harmonic is exact: the radial part of the force is k r^2 / a, the other k r sqrt(1 - (r / a)^2)."""
    scene = CIRCLE.scene((0.6, 1.8))
    response = fcm.respond(scene, "closed-form", harmonics=1)
    w, a = response.frequency.values[0], response.amplitude.values[0, :, 0]
    r = CIRCLE.mu * CIRCLE.n_0 / CIRCLE.k_u
    assert (a > r).all()
    force = (1.0 - w**2 + 0.1j * w) * a + r * r / a + 1j * r * np.sqrt(1.0 - (r / a) ** 2)
    assert np.abs(np.abs(force) - 1.0).max() < 1e-12
    assert response.regime.values[0, 5, 0] == "P"
    # far above r the peak is where the mass resonates with the radial part: the real part vanishes
    fine = np.linspace(0.9, 1.3, 400001)
    peak = max(_circle(one, r) for one in fine[::4000])
    top = float(response.peak_frequency.sel(dof="x")[0])
    near = max(_circle(one, r) for one in np.linspace(top - 1e-3, top + 1e-3, 41))
    assert response.peak_amplitude.sel(dof="x")[0] == pytest.approx(near, rel=1e-6)
    assert near >= peak


def _circle(w, r):
    """The radius of the motion: where the size of the force is 1, by bisection."""
    low, high = r, 100.0
    for _ in range(80):
        a = 0.5 * (low + high)
        force = complex((1.0 - w * w) * a + r * r / a, 0.1 * w * a + r * sqrt(1.0 - (r / a) ** 2))
        low, high = (a, high) if abs(force) < 1.0 else (low, a)
    return low


@pytest.mark.slow
@pytest.mark.parametrize(
    ("oscillators", "omega", "sequence"),
    [
        (CIRCLE, 0.9, "P"),
        (OBLIQUE, 0.9, "EPEP"),
        (ELLIPSE, 1.25, "EPEP"),
        (ELLIPSE, 0.9, "EPEP"),
        (OPENS, 1.25, "PS"),
    ],
)
def test_motions_against_a_march(oscillators, omega, sequence):
    scene = oscillators.scene((0.5, 2.0))
    marched = oscillators.extrapolated(omega, 50, 200)
    found = amplitudes(scene, omega, 9)[2]
    moves = marched > 0.0
    assert found[moves] == pytest.approx(marched[moves], rel=1e-4)
    response = trace_levels(scene, LevelRequest([omega], (0.9, 1.1)), harmonics=(1, 2, 3))
    point = np.abs(response.curves[0].level - 1.0).argmin()
    assert response.curves[0].regime[point, 0] == sequence


@pytest.mark.slow
@pytest.mark.parametrize("oscillators", [ELLIPSE, OBLIQUE])
def test_peaks_with_the_default_accuracy_against_a_march(oscillators):
    """Within it, and the error told is the true one."""
    scene = replace(oscillators.scene((0.6, 1.8)), harmonics=None)
    found = fcm.respond(scene, "closed-form").sel(dof="x")
    top, aside = float(found.peak_frequency[0]), 2e-3
    low, middle, high = (oscillators.extrapolated(top + k * aside, 60, 200)[0] for k in (-1, 0, 1))
    marched = middle + (high - low) ** 2 / (8.0 * (2.0 * middle - low - high))
    error = abs(float(found.peak_amplitude[0]) / marched - 1.0)
    assert error < 1e-3
    assert float(found.peak_error[0]) == pytest.approx(error, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("oscillators", "omega"), [(CIRCLE, 0.9), (OBLIQUE, 0.9), (ELLIPSE, 0.9), (ELLIPSE, 1.25), (OPENS, 1.25)]
)
def test_multipliers_against_marches_from_disturbed_states(oscillators, omega):
    """Each state disturbed by itself, and what becomes of that in a period: a matrix with the same values."""
    system, z, _ = amplitudes(oscillators.scene((0.5, 2.0)), omega, 7)
    found = multipliers(system, z)
    steps, little = 2000, 1e-6
    rest, _ = oscillators.march(omega, 40, steps)
    columns = []
    for i in range(8):
        sides = []
        for sign in (1.0, -1.0):
            state = list(rest)
            state[i] += sign * little
            sides.append(oscillators.march(omega, 1, steps, state)[0])
        columns.append(np.subtract(*sides) / (2.0 * little))
    marched = np.linalg.eigvals(np.array(columns).T)
    marched = np.array(sorted(marched, key=abs, reverse=True))[: found.size]
    assert np.abs(found[:6]) == pytest.approx(np.abs(marched[:6]), abs=6e-3)


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [1, 3])
@pytest.mark.parametrize("name", ["yang1998-n5", "two-contacts"])
def test_a_second_direction_that_never_moves_is_a_line(name, harmonics):
    """Peaks, folds, errors and stability are those of contacts on a line."""
    data = single(name)
    line, plane = (
        fcm.respond(scene_from_dict(one), "closed-form", harmonics=harmonics)
        for one in (data, with_still(data))
    )
    dofs = line.dof.values
    for variable in ("peak_amplitude", "peak_frequency", "peak_stable"):
        other = plane[variable].sel(dof=dofs).values
        # where the two curves have a top is told to the square root of the rounding
        rel = 1e-6 if variable == "peak_frequency" else 1e-9
        assert other == pytest.approx(line[variable].values, rel=rel, nan_ok=True)
    assert plane.fold_frequency.values == pytest.approx(line.fold_frequency.values, rel=1e-9)
    assert plane.peak_error.sel(dof=dofs).values == pytest.approx(line.peak_error.values, rel=0.02, abs=1e-6)
    assert _changes(plane) == pytest.approx(_changes(line), abs=2e-3)


@pytest.mark.parametrize("harmonics", [1, 3])
def test_what_a_still_direction_says_of_forces_and_energy_is_that_of_a_line(harmonics):
    data = single("yang1998-n5", response={"frequency": [1.1, 1.4]})
    line, plane = (
        fcm.respond(scene_from_dict(one), "closed-form", harmonics=harmonics)
        for one in (data, with_still(data))
    )
    for name in ("greatest_normal_force", "greatest_friction_force", "slip_path", "dissipated_energy"):
        for end in (0, -1):
            found = plane[name].isel(curve=0).dropna("point").isel(point=end).values
            expected = line[name].isel(curve=0).dropna("point").isel(point=end).values
            assert found == pytest.approx(expected, rel=1e-9), name
    limit = 0.4 * plane.greatest_normal_force
    assert float((plane.greatest_friction_force / limit).max()) <= 1.0 + 1e-12


def _changes(response):
    """Frequencies at which what is told of stability changes."""
    stable, w = response.stable.values[0], response.frequency.values[0]
    told = ~np.isnan(stable)
    at = np.flatnonzero(np.diff(stable[told]))
    return w[told][at].tolist()


def test_turned_axes_turn_the_response():
    """A structure whose modes and forces are turned has the same amplitudes along its own axes."""
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shapes = np.array([[1.0, 0.2, 0.1], [-0.2, 1.0, 0.3], [0.1, -0.3, 1.0]])
    found = []
    for along, push in ((shapes, np.eye(3)), (shapes @ turn, turn)):
        forces = [
            {"dof": dict(zip("xyz", (push[i] @ np.eye(3)).tolist(), strict=True)), "amplitude": f, "phase": p}
            for i, (f, p) in enumerate(((1.0, 0.0), (0.6, 1.0)))
        ]
        scene = ELLIPSE.scene((0.8, 1.2), force=forces)
        modal = replace(scene.modal, shapes=np.ascontiguousarray(along))
        system = System(replace(scene, modal=modal), (1, 2, 3))
        z = solutions(system, 1.0).solutions[0]
        quantities = reported_at(system, z[None], np.zeros((1, z.size)))
        found.append(quantities.X[0])
    assert np.abs(found[0] @ turn - found[1]).max() < 1e-9 * np.abs(found[0]).max()


def test_a_contact_that_slips_all_the_time_has_no_corners():
    """Where its period is begun rounding may put a stick, whose slider the slip takes back to where it was.

    Nor is it a corner where two sticks appear, with no length at first.
    """
    lag = (QUARTER, QUARTER - 1.6, QUARTER - 0.4)
    slides = replace(ELLIPSE, force=(1.0, 0.9, 0.5), lag=lag)
    (path,) = traced(System(slides.scene((0.8, 1.4)), (1, 2, 3))).branches.paths
    assert path.status is Status.COMPLETE
    law = slides.mu, slides.k_u, slides.k_v, slides.n_0
    found = set()
    for z in path.z[::4]:
        motion = np.concatenate((z[None, :3] + 0j, z[3:-1].copy().view(complex).reshape(-1, 3)))
        found.add(fcm.planar_loop(*motion.T, *law).sequence)
    assert found == {"P", "EPEP"}
    assert not path.where(Mark.CORNER).size


def test_a_line_beside_a_plane():
    """A contact on a line in a scene with one in a plane is one whose second direction nothing moves."""
    data = single("two-contacts", response={"frequency": [0.8, 1.2], "harmonics": 3})
    mixed = with_still(data)
    mixed["contact"] = [mixed["contact"][0], *data["contact"][1:]]
    one, other = (fcm.respond(scene_from_dict(each), "closed-form") for each in (data, mixed))
    peaks = other.peak_amplitude.sel(dof=one.dof.values).values
    assert peaks == pytest.approx(one.peak_amplitude.values, rel=1e-9)


def test_the_exact_motion_is_refused_with_the_reason():
    with pytest.raises(ResponseError, match=r'contact "pad": the exact motion .* in a plane'):
        trace_exact(ELLIPSE.scene((0.9, 1.1)))


@pytest.mark.slow
def test_what_the_file_says_of_a_contact_in_a_plane():
    response = fcm.respond(ELLIPSE.scene((0.95, 1.05)), "closed-form", harmonics=3)
    assert response.direction.values.tolist() == ["x", "y", "normal"]
    point = {"curve": 0, "point": 3, "contact": 0}
    u_x, u_y, v = (
        response.contact_amplitude.isel(**point, direction=i).values
        * np.exp(1j * response.contact_phase.isel(**point, direction=i).values)
        / 1j
        for i in range(3)
    )
    means = response.contact_mean.isel(**point).values
    loop = fcm.planar_loop(
        *(np.append(mean, u) for mean, u in zip(means, (u_x, u_y, v), strict=True)),
        ELLIPSE.mu, ELLIPSE.k_u, ELLIPSE.k_v, ELLIPSE.n_0,
    )  # fmt: skip
    assert response.regime.isel(**point).item() == loop.sequence
    assert response.dissipated_energy.isel(**point).item() == pytest.approx(loop.dissipation, rel=1e-6)
    assert response.slip_path.isel(**point).item() == pytest.approx(loop.slip_path, rel=1e-6)
    assert response.greatest_friction_force.isel(**point).item() == pytest.approx(
        loop.greatest_force, rel=1e-5
    )
    f_x, f_y, _ = fcm.planar_forces(loop.u_x, loop.u_y, loop.v, loop.mu, loop.k_u, loop.k_v, loop.n_0)
    assert response.friction_x.isel(**point).item() == pytest.approx(abs(f_x[1]), rel=1e-9)
    assert response.friction_y.isel(**point).item() == pytest.approx(abs(f_y[1]), rel=1e-9)


def test_each_quantity_of_a_contact_in_a_plane_has_one_column(tmp_path):
    response = trace_levels(ELLIPSE.scene((0.9, 1.1)), LevelRequest([1.0], (0.5, 1.0)), harmonics=(1,))
    write_csv(response, tmp_path / "plane.csv")
    with (tmp_path / "plane.csv").open(newline="", encoding="utf-8") as file:
        heads, *rows = csv.reader(file)
    assert len(heads) == len(set(heads))
    (curve,) = response.curves
    friction = [heads.index(f"friction_{axis} pad") for axis in "xy"]
    work = heads.index("dissipated_energy pad")
    assert len(rows) == curve.frequency.size
    for k in (0, len(rows) - 1):
        assert [float(rows[k][i]) for i in friction] == curve.across.friction[k, 0].tolist()
        assert float(rows[k][work]) == curve.cycle[k, 0, 3]
    assert float(rows[-1][work]) > 0.0


@pytest.mark.slow
def test_the_bundled_damper_and_what_one_direction_misses():
    """Each direction alone leaves the other without friction; its own peak is too high as well."""
    scene = fcm.load_scene("platform-damper")
    (damper,) = scene.contacts
    along_x, along_y = (replace(damper, tangential=one, second=None) for one in damper.directions[:2])
    tips = []
    for contact in (damper, along_x, along_y):
        response = fcm.respond(replace(scene, contacts=(contact,), draft=None), "closed-form")
        assert response.complete[0] == 1
        tips.append(response.peak_amplitude.sel(dof=["tip_x", "tip_y"]).values[0])
    plane, x, y = tips
    assert (x / plane)[1] > 2.0
    assert (y / plane)[0] > 2.5
    assert 1.05 < (x / plane)[0] < 1.2
    assert 1.05 < (y / plane)[1] < 1.2


@pytest.mark.slow
def test_levels_modes_sensitivities_and_tracks_of_a_still_direction_are_those_of_a_line():
    data = single("yang1998-n5", response={"frequency": [1.1, 1.4], "max_step": 0.1})
    line, plane = (scene_from_dict(one) for one in (data, with_still(data)))
    levels = [
        trace_levels(one, LevelRequest([1.2], (0.2, 1.5)), harmonics=(1, 2, 3)).curves[0]
        for one in (line, plane)
    ]
    assert levels[1].level_folds == pytest.approx(levels[0].level_folds, rel=1e-9)
    assert levels[1].amplitude[-1][:2] == pytest.approx(levels[0].amplitude[-1], rel=1e-9)
    modes = [
        trace_modes(one, ModeRequest(1, (0.1, 20.0)), harmonics=(1, 3)).curves[0] for one in (line, plane)
    ]
    assert modes[1].frequency[-1] == pytest.approx(modes[0].frequency[-1], rel=1e-9)
    assert modes[1].mode.damping.max() == pytest.approx(modes[0].mode.damping.max(), rel=1e-9)
    peaks = [fcm.respond(one, "closed-form", harmonics=1, sensitivity=True) for one in (line, plane)]
    numbers = peaks[0].number.values
    assert peaks[1].sensitivity.values[0, 0, : numbers.size] == pytest.approx(
        peaks[0].sensitivity.values[0, 0], rel=1e-6, abs=1e-9
    )
    tracks = [
        track(one, TrackRequest("folds", "contact.shroud.n_0", (4.9, 5.1)), harmonics=(1,))
        for one in (line, plane)
    ]
    ends = [sorted(float(curve.frequency[-1]) for curve in one.tracking.curves) for one in tracks]
    assert ends[1] == pytest.approx(ends[0], rel=1e-9)


def test_the_onset_of_slip_in_a_plane_moves_as_its_slopes_say():
    """Overlap of all discs, and how far the start is from them, against differences."""
    rng = np.random.default_rng(3)
    numbers = {"mu": 0.5, "k_u": 1.3, "k_v": 0.7, "n_0": 4.0}
    for harmonics in ((1,), (1, 2, 3)):
        kernel, width = planar_contact(harmonics, harmonics), 3 + 6 * len(harmonics)
        for kind in ("slip", "start"):
            x = rng.standard_normal(width)
            found = onset(*laws_in_a_plane(kernel, [SimpleNamespace(**numbers)]), x, kind, harmonics)

            def value(at, kind=kind, harmonics=harmonics, kernel=kernel, **other):
                (law,) = laws_in_a_plane(kernel, [SimpleNamespace(**(numbers | other))])
                return onset(law, at, kind, harmonics).value

            h = 1e-6
            slope = [(value(x + h * one) - value(x - h * one)) / (2.0 * h) for one in np.eye(width)]
            assert found.slope == pytest.approx(slope, abs=1e-6)
            by = [(value(x, **{k: v + h}) - value(x, **{k: v - h})) / (2.0 * h) for k, v in numbers.items()]
            assert found.by_number == pytest.approx(by, abs=1e-6)


def test_the_onset_of_slip_on_a_straight_way_is_that_of_a_line():
    x = np.array([0.1, 0.3, 1.0, 0.2, 0.4, -0.5])
    contact = SimpleNamespace(mu=0.5, k_u=1.3, k_v=0.7, n_0=4.0)
    line = onset(*laws_on_a_line(periodic_contact((1,), (1,)), [contact]), x, "slip", (1,))
    oblique = np.array([0.06, 0.08, 0.3, 0.6, 0.12, 0.8, 0.16, 0.4, -0.5])
    plane = onset(*laws_in_a_plane(planar_contact((1,), (1,)), [contact]), oblique, "slip", (1,))
    assert plane.value == pytest.approx(line.value, rel=1e-12)
    assert plane.by_number == pytest.approx(line.by_number, abs=1e-7)


ROTATING = {"span": (0.6, 1.8), "n_0": 2.0, "mu": 0.4, "k_u": 1.0, "damping": 0.02, "force": (1.0, 1.0, 0.0)}


def rotating(
    lag=QUARTER, frequency=(1.0, 1.0, 10.0), coupled=0.0, second=False, harmonics=1, optimum=None, **more
):
    """Two isotropic modes under a force that turns, and how that may be spoilt, as a scene."""
    given = ROTATING | more
    shapes, natural = np.eye(3), list(frequency)
    shapes[2, :2] = coupled, 0.5 * coupled  # of the normal mode, along the contact
    if second:
        natural += [1.5, 1.5]
        shapes = np.vstack([shapes, [[0.6, 0.0, 0.0], [0.0, 0.6, 0.0]]])
    x, y, z = given["force"]
    forces = [{"dof": "x", "amplitude": x}, {"dof": "y", "amplitude": y, "phase": -lag}]
    contact = {"name": "pad", "tangential": ["x", "y"], "normal": "z", "k_v": 1.0}
    data = {
        "modal": {
            "dofs": ["x", "y", "z"], "frequency": natural, "damping": [given["damping"]] * len(natural),
            "shapes": shapes.tolist(),
        },
        "contact": [contact | {key: given[key] for key in ("mu", "k_u", "n_0")}],
        "force": forces + ([{"dof": "z", "amplitude": z}] if z else []),
        "response": {"frequency": list(given["span"]), "harmonics": harmonics},
    }  # fmt: skip
    return scene_from_dict(data | ({"optimum": optimum} if optimum else {}))


@pytest.mark.slow
@pytest.mark.parametrize(
    "varied",
    [
        {},
        {"n_0": 1.0},
        {"n_0": 4.0},
        {"n_0": 0.3},
        {"mu": 0.1},
        {"mu": 1.0},
        {"k_u": 4.0},
        {"k_u": 0.2},
        {"damping": 0.001},
        {"damping": 0.1},
    ],
)
def test_a_circle_begins_and_ceases_to_slip_all_around_at_once(varied):
    """The curve goes on there, though on the slip side it leaves the limit as the square of the way."""
    given = ROTATING | varied
    response = fcm.respond(rotating(**varied), "closed-form", harmonics=1)
    assert "reason" not in response and "branches_unsure_at" not in response
    r, k, c = given["mu"] * given["n_0"] / given["k_u"], given["k_u"], 2.0 * given["damping"]

    def radius(w):
        """Where the size of the force is 1, stuck or slipping."""
        stuck = 1.0 / abs(1.0 + k - w * w + 1j * c * w)
        if stuck <= r:
            return stuck
        low, high = r, 1e4
        for _ in range(100):
            a = 0.5 * (low + high)
            rest = complex((1.0 - w * w) * a + k * r * r / a, c * w * a + k * r * sqrt(1.0 - (r / a) ** 2))
            low, high = (a, high) if abs(rest) < 1.0 else (low, a)
        return low

    w, a = response.frequency.values[0], response.amplitude.values[0, :, 0]
    kept = np.isfinite(w)
    assert a[kept] == pytest.approx([radius(one) for one in w[kept]], rel=1e-9)
    top = float(response.peak_frequency.sel(dof="x")[0])
    highest = max(radius(one) for one in np.linspace(top - 1e-4, top + 1e-4, 41))
    assert response.peak_amplitude.sel(dof="x")[0] == pytest.approx(highest, rel=1e-6)
    assert highest >= max(radius(one) for one in np.linspace(*given["span"], 401))


@pytest.mark.slow
@pytest.mark.parametrize(
    "varied",
    [
        {"second": True, "span": (0.5, 2.5)},  # stops to slip at a corner of more than a right angle
        {"force": (1.0, 1.0 - 1e-6, 0.0)},
        {"force": (1.0, 0.999, 0.0)},
        {"force": (1.0, 0.5, 0.0)},
        {"lag": 0.8},
        {"force": (1.0, 1.0, 1e-3)},
        {"force": (1.0, 1.0, 1.0)},
        {"force": (1.0, 1.0, 3.0), "frequency": (1.0, 1.0, 2.0)},
        {"n_0": -1.0, "force": (1.0, 1.0, 3.0), "frequency": (1.0, 1.0, 2.0)},
        {"coupled": 0.1, "frequency": (1.0, 1.0, 3.0)},
        {"coupled": 0.5, "frequency": (1.0, 1.0, 3.0)},
        {"harmonics": 3, "force": (1.0, 1.0, 1.0)},
    ],
)
def test_no_curve_stops_where_slip_begins(varied):
    scene = rotating(**varied)
    system = System(scene, tuple(range(1, varied.get("harmonics", 1) + 1)))
    found = traced(system)
    assert all(one.complete for one in found.found) and not found.branches.lost
    ways = found.branches.paths
    assert all(way.status is Status.COMPLETE for way in ways)
    reached = np.concatenate([way.parameter for way in ways])
    assert (reached.min(), reached.max()) == pytest.approx(scene.frequency_range, abs=1e-12)
