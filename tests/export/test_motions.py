"""What goes back to other programs: displacements of all rows, contact forces, against independent sums."""

import csv
import json
import shutil
from dataclasses import replace

import h5py
import meshio
import netCDF4
import numpy as np
import pytest
import pyuff
import scipy.linalg
from tests.oscillator import oscillator
from tests.program import called, ended
from tests.scene.test_matrix_formats import BEAM

import fcm
from fcm.export import motions_of
from fcm.response import trace
from fcm.scene.formats.calculix import calculix_names

ZETA, MODES = 0.002, 36
SCENE = f"""
[structure]
stiffness = "{BEAM}/beam.sti"
mass = "{BEAM}/beam.mas"
damping = {ZETA}
modes = {MODES}
[[contact]]
name = "stop"
tangential = "16y"
normal = "16z"
mu = 0.3
k_u = 1e6
k_v = 1e6
n_0 = 20.0
[[force]]
dof = "16y"
amplitude = 40.0
[[load]]
dof = "8z"
force = 3.0
[response]
frequency = [4200.0, 5200.0]
harmonics = 3
output = "16?"
"""


def triangle(ending, names):
    """The matrix of a triangle, by the rows that its lines name."""
    table = np.loadtxt(BEAM / f"beam.{ending}")
    full = np.zeros((len(names), len(names)))
    for row, column, value in table:
        full[int(row) - 1, int(column) - 1] = full[int(column) - 1, int(row) - 1] = value
    return full


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Files of one run at two frequencies, and the names of the rows."""
    folder = tmp_path_factory.mktemp("export")
    (folder / "model.toml").write_text(SCENE)
    common = (folder / "model.toml", "--mesh", BEAM / "beam.inp", "--motion-at", 4500, "--motion-at", 4680.5)
    more = ("-o", folder / "c.nc", "--contact-forces", folder / "f.csv", "--modal-amplitudes")
    for ending, options in (("vtu", more), ("h5", ()), ("uff", ())):
        done = called("respond", *common, "--export", folder / f"c.{ending}", *options)
        assert done.code == 0, done.err
        assert "4 nodes of 16 have no row" in done.err
    names = calculix_names((BEAM / "beam.dof").read_text().splitlines(), "beam.dof")
    return folder, names


@pytest.mark.slow
def test_a_mesh_without_elements_is_said_to_have_no_surfaces(made):
    folder, _ = made
    lines = (BEAM / "beam.inp").read_text().upper().partition("*NODE")[2].splitlines()[1:]
    nodes = [",".join(map(str.strip, one.split(","))) for one in lines[: [x[:1] for x in lines].index("*")]]
    (folder / "nodes.csv").write_text("node,x,y,z\n" + "\n".join(nodes) + "\n")
    model = ("respond", folder / "model.toml", "--motion-at", 4500, "--export")
    done = called(*model, folder / "p.vtu", "--mesh", folder / "nodes.csv")
    assert done.code == 0 and "p.vtu has points alone; an .inp, a .bdf or an .msh has surfaces" in done.err
    done = called(*model, folder / "s.vtu", "--mesh", BEAM / "beam.inp")
    assert done.code == 0 and "points alone" not in done.err


def waves_of(folder):
    """(motion, harmonic, row), (motion, row), and frequencies, of the HDF5 file."""
    with h5py.File(folder / "c.h5") as file:
        names = [name.decode() for name in file["row"][:]]
        return names, file["displacement"][:], file["mean"][:], file["frequency"][:]


def forces_of(folder, contacts=1):
    """(motion, contact, direction, harmonic) of the netCDF file, the mean first."""
    with netCDF4.Dataset(folder / "c.nc") as data:
        waves = data["contact_force_amplitude"][:] * np.exp(1j * data["contact_force_phase"][:])
        mean = data["contact_force_mean"][:]
    assert waves.shape[1] == contacts
    return np.concatenate((np.asarray(mean)[..., None], np.asarray(waves)), axis=-1)


def test_all_rows_move_as_the_matrices_under_the_contact_forces(made):
    """The equation of motion of the whole structure, with modes by LAPACK from the files' numbers."""
    folder, names = made
    K, M = triangle("sti", names), triangle("mas", names)
    square, shapes = scipy.linalg.eigh(K, M)
    rows, waves, mean, frequency = waves_of(folder)
    assert rows == list(names) and waves.shape == (2, 3, 36)
    at = {name: i for i, name in enumerate(rows)}
    forces = forces_of(folder)
    for m, omega in enumerate(frequency):
        for j in range(4):
            push = np.zeros(36, dtype=complex)
            push[at["16y"]] = (40.0 if j == 1 else 0.0) - forces[m, 0, 0, j]
            push[at["16z"]] = -(forces[m, 0, 1, j] - (20.0 if j == 0 else 0.0))
            push[at["8z"]] += 3.0 if j == 0 else 0.0
            w = j * omega
            modal = shapes.T @ push / (square - w**2 + 2j * ZETA * np.sqrt(square) * w)
            expected, found = shapes @ modal, mean[m] if j == 0 else waves[m, j - 1]
            assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def test_a_nonlinear_mode_moves_freely_with_the_damping_that_gives_back_what_friction_takes(tmp_path):
    """All rows by the matrices: M x'' + (C - 2 D omega M) x' + K x + f = load; its modal amplitude is that
    asked for."""
    (tmp_path / "model.toml").write_text(SCENE)
    amplitude, files = 1e-4, ("-o", tmp_path / "c.nc", "--contact-forces", tmp_path / "f.csv")
    mode = ("respond", tmp_path / "model.toml", "--mode", 2, "--level", f"1e-6:{amplitude}")
    done = called(*mode, *files, "--export", tmp_path / "c.h5", "--motion-at", amplitude)
    assert done.code == 0, done.err
    names = calculix_names((BEAM / "beam.dof").read_text().splitlines(), "beam.dof")
    K, M = triangle("sti", names), triangle("mas", names)
    square, shapes = scipy.linalg.eigh(K, M)
    _, waves, mean, (omega,) = waves_of(tmp_path)
    forces, at = forces_of(tmp_path), {name: i for i, name in enumerate(names)}
    with netCDF4.Dataset(tmp_path / "c.nc") as data:
        D = float(data["damping_ratio"][0, -1])
        assert float(data["frequency"][0, -1]) == pytest.approx(omega, rel=1e-9)
    first = shapes.T @ M @ waves[0, 0]
    assert np.linalg.norm(first) == pytest.approx(amplitude, rel=1e-6) and D > 1.2 * ZETA
    for j in range(4):
        push = np.zeros(36, dtype=complex)
        push[at["16y"]] = -forces[0, 0, 0, j]
        push[at["16z"]] = -(forces[0, 0, 1, j] - (20.0 if j == 0 else 0.0))
        push[at["8z"]] += 3.0 if j == 0 else 0.0
        w, moved = j * omega, shapes.T @ M @ (mean[0] if j == 0 else waves[0, j - 1])
        free = square - w**2 + 2j * w * (ZETA * np.sqrt(square) - D * omega)
        left = free * moved - shapes.T @ push
        assert np.abs(left).max() < 1e-6 * np.abs(square * first).max()
    rows = list(csv.DictReader((tmp_path / "f.csv").open()))
    assert {row["peak of"] for row in rows} == {"mode at 0.0001"}


def test_the_motions_of_a_mode_are_its_resonances_where_none_is_asked_for(tmp_path):
    """Of a curve without one that of the greatest amplitude. A free motion has no spectrum."""
    (tmp_path / "model.toml").write_text(SCENE)
    mode = ("respond", tmp_path / "model.toml", "--mode", 2, "--level", "1e-6:1e-4", "--json")
    for level in (0.3, 1000):
        done = called(*mode, "--force-level", level, "--export", tmp_path / "c.uff")
        found = json.loads(done.out)["curves"][0]["mode"]
        sets = pyuff.UFF(str(tmp_path / "c.uff")).read_sets()
        expected = [one["frequency"] for one in found["resonances"]] or [found["frequency"][1]]
        assert {one["type"] for one in sets} == {55}
        # a resonance of the forces is where their answer is greatest, below the frequency of the mode
        assert sets[0]["freq"] * 2.0 * np.pi == pytest.approx(expected[0], rel=1e-3)


def test_the_contact_forces_are_those_of_the_motion_across_the_contact(made):
    """The motion from the exported rows, its forces by `fcm.periodic_forces`."""
    folder, _ = made
    rows, waves, mean, _ = waves_of(folder)
    forces = forces_of(folder)
    for m in range(2):
        u, v = (
            np.concatenate(([mean[m, rows.index(name)]], waves[m, :, rows.index(name)] / 1j))
            for name in ("16y", "16z")
        )
        f, n = fcm.periodic_forces(u, v, 0.3, 1e6, 1e6, 20.0)
        for k, exact in enumerate((f, n)):
            exact[1:] *= 1j
            assert np.abs(forces[m, 0, k] - exact).max() < 1e-7 * np.abs(n).max()
        assert n[0].real == pytest.approx(20.0, rel=0.1)  # with the preload


def test_the_table_of_forces_has_the_numbers_of_the_file(made):
    folder, _ = made
    forces = forces_of(folder)
    with (folder / "f.csv").open() as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == 2 * 1 * 2 * 4 and lines[0]["contact"] == "stop"
    for k, line in enumerate(lines):
        m, d, h = k // 8, k // 4 % 2, int(line["harmonic"])
        assert (
            line["force"] == ("friction", "normal")[d]
            and float(line["frequency [rad/s]"]) == (4500, 4680.5)[m]
        )
        value = complex(float(line["real"]), float(line["imag"]))
        assert value == pytest.approx(forces[m, 0, d, h], rel=1e-12)
        if h:
            polar = float(line["amplitude"]) * np.exp(1j * float(line["phase [rad]"]))
            assert value == pytest.approx(polar, rel=1e-12)


def test_modal_amplitudes_and_the_scenes_shapes_are_the_reported_motion(made):
    folder, _ = made
    scene = fcm.load_scene(folder / "model.toml")
    with netCDF4.Dataset(folder / "c.nc") as data:
        q = np.asarray(
            data["mode_displacement_amplitude"][:] * np.exp(1j * data["mode_displacement_phase"][:])
        )
        assert data["motion_frequency"][:].tolist() == [4500.0, 4680.5]
    rows, waves, _, _ = waves_of(folder)
    shapes = scene.modal.shapes / np.sqrt(scene.modal.mass)[:, None]
    for name in ("16x", "16y", "16z"):
        found = np.einsum("nmh,m->nh", q, shapes[:, scene.modal.dofs.index(name)])
        assert np.abs(found - waves[:, :, rows.index(name)]).max() < 1e-12 * np.abs(waves).max()


def test_paraviews_file_has_the_mesh_and_the_displacements(made):
    folder, _ = made
    read = meshio.read(folder / "c.vtu")
    rows, waves, mean, _ = waves_of(folder)
    number = read.point_data["node_number"]
    assert number.tolist() == list(range(1, 17)) and read.points[15].tolist() == [0.3, 0.05, 0.04]
    assert read.cells[0].type == "hexahedron" and read.cells[0].data[0].tolist() == [0, 1, 5, 4, 8, 9, 13, 12]
    held = [node for node, has in zip(number, read.point_data["has_rows"], strict=True) if not has]
    assert held == [1, 5, 9, 13]
    for m, label in enumerate(("at_4500_rad_s", "at_4680.5_rad_s")):
        for row, name in enumerate(rows):
            place, direction = int(name[:-1]) - 1, "xyz".index(name[-1])
            for j in range(3):
                parts = (read.point_data[f"{label}_h{j + 1}_{part}"] for part in ("real", "imag"))
                real, imag = (part[place, direction] for part in parts)
                assert complex(real, imag) == waves[m, j, row]
            assert read.point_data[f"{label}_mean"][place, direction] == mean[m, row]
        assert not read.point_data[f"{label}_h1_real"][[0, 4, 8, 12]].any()


def test_paraviews_file_has_what_the_contacts_bear_at_their_nodes(made):
    """Energy by the harmonics of force and displacement, the normal force by the displacement in time."""
    folder, _ = made
    read, forces = meshio.read(folder / "c.vtu").point_data, forces_of(folder)
    rows, waves, mean, _ = waves_of(folder)
    h, turn = np.arange(1, 4), np.exp(1j * np.outer(np.arange(1, 4), np.linspace(0.0, 2.0 * np.pi, 4001)))
    for m, label in enumerate(("at_4500_rad_s", "at_4680.5_rad_s")):
        u, v = (waves[m, :, rows.index(name)] for name in ("16y", "16z"))
        load = 20.0 + 1e6 * (mean[m, rows.index("16z")] + (v @ turn).imag)
        expected = {
            "energy": np.pi * np.sum(h * (forces[m, 0, 0, 1:] * u.conj()).imag),
            "greatest_normal_force": load.max(),
            "state": 2 if load.min() < 0.0 else 1,
        }
        for name, value in expected.items():
            found = read[f"{label}_{name}"]
            assert found[15] == pytest.approx(value, rel=1e-6) and value > 0.0
            assert set(found[:15]) == {-1 if name == "state" else 0.0}
        slip = read[f"{label}_slip_path"]  # friction of at most mu n takes the energy along it
        assert slip[15] * 0.3 * load.max() > expected["energy"] and not slip[:15].any()


def test_the_weights_of_a_direction_take_nothing_from_the_energy_of_its_node(made, tmp_path):
    """With a normal displacement of a fiftieth the same contact has fifty times the normal forces."""
    folder, _ = made
    scene = SCENE.replace('normal = "16z"', "normal = { 16z = 0.02 }").replace("mu = 0.3", "mu = 0.006")
    scene = scene.replace("k_v = 1e6", "k_v = 2.5e9").replace("n_0 = 20.0", "n_0 = 1000.0")
    (tmp_path / "model.toml").write_text(scene)
    done = called(
        "respond", tmp_path / "model.toml", "--mesh", BEAM / "beam.inp", "--motion-at", 4500, "--export",
        tmp_path / "c.vtu",
    )  # fmt: skip
    assert done.code == 0, done.err
    scaled, plain = (meshio.read(one / "c.vtu").point_data for one in (tmp_path, folder))
    for what, factor in (("energy", 1.0), ("slip_path", 1.0), ("greatest_normal_force", 50.0)):
        name = f"at_4500_rad_s_{what}"
        assert scaled[name] == pytest.approx(factor * plain[name], rel=1e-6) and plain[name][15] > 0.0


def test_a_mesh_of_some_nodes_will_do(made, tmp_path):
    folder, _ = made
    (tmp_path / "some.csv").write_text("node,x,y,z\n16,0.3,0.05,0.04\n8,0.3,0.05,0\n1,0,0,0\n")
    options = ("--motion-at", 4500, "--motion-at", 4680.5, "--export", tmp_path / "some.vtu")
    done = called("respond", folder / "model.toml", *options, "--mesh", tmp_path / "some.csv")
    assert done.code == 0, done.err
    assert (
        done.err.count("has 2 of the 12 nodes of the structure") == 1
        and "10 nodes (2, 3, 4, ...)" in done.err
    )
    some, every = (meshio.read(one).point_data for one in (tmp_path / "some.vtu", folder / "c.vtu"))
    assert some.keys() == every.keys()
    for name, values in some.items():
        assert values == pytest.approx(every[name][[15, 7, 0]])


def test_the_universal_file_has_shapes_and_spectra(made):
    folder, _ = made
    rows, waves, _, _ = waves_of(folder)
    sets = pyuff.UFF(str(folder / "c.uff")).read_sets()
    kinds = [one["type"] for one in sets]
    assert kinds == [2411] + [55] * 6 + [58] * 4
    assert [sets[0][key][15] for key in ("node_nums", "x", "y", "z")] == [16, 0.3, 0.05, 0.04]
    for k, one in enumerate(sets[1:7]):
        m, j = divmod(k, 3)
        assert one["freq"] == pytest.approx((j + 1) * (4500.0, 4680.5)[m] / (2 * np.pi), rel=1e-5)
        for node, *xyz in zip(one["node_nums"], one["r1"], one["r2"], one["r3"], strict=True):
            expected = np.array([waves[m, j, rows.index(f"{int(node)}{d}")] for d in "xyz"])
            assert np.abs(np.array(xyz) - expected).max() <= 1e-5 * np.abs(expected).max()
    with netCDF4.Dataset(folder / "c.nc") as data:
        dof = data["dof"][:].tolist().index("16y")
        frequency, size = np.asarray(data["frequency"][0]), np.asarray(data["fundamental"][0, :, dof])
        value = size * np.exp(1j * np.asarray(data["phase"][0, :, dof]))
    (one,) = (one for one in sets[7:] if "16y" in one["id1"])
    assert (one["rsp_node"], one["rsp_dir"]) == (16, 2)
    assert one["x"] == pytest.approx(frequency / (2 * np.pi), rel=1e-5)
    assert np.abs(one["data"] - value).max() < 1e-11 * size.max()


@pytest.mark.slow
def test_forces_in_a_plane_are_those_of_the_motion():
    scene = fcm.load_scene("platform-damper").in_use()
    response = trace(scene, harmonics=3)
    motions = motions_of(response, scene)
    assert len(motions) == 4
    (contact,) = scene.contacts
    for motion in motions:
        curve = response.curves[motion.curve]
        point = int(np.nanargmax(curve.amplitude[:, scene.modal.dofs.index(motion.of[0])]))
        across = [
            np.concatenate(([curve.mean[point] @ along], curve.harmonic[point] @ along / 1j))
            for along in contact.directions
        ]
        exact = fcm.planar_forces(*across, contact.mu, contact.k_u, contact.k_v, contact.n_0)
        for found, one in zip(motion.force[0], exact, strict=True):
            one[1:] *= 1j
            assert np.abs(found - one).max() < 1e-9 * np.abs(exact[2]).max()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["two-contacts", "blade", "bladed-disk"])
def test_the_fundamental_of_a_peak_is_that_of_its_curve(name):
    """Contacts and modes that a run leaves out are there; a ring's sector has its contact forces."""
    scene = fcm.load_scene(name).in_use()
    scene = replace(scene, curves=scene.curves[:1])
    response = trace(scene, harmonics=1)
    motions = motions_of(response, scene)
    assert len(motions) == min(4, sum(map(scene.asks_for, scene.modal.dofs))) * len(response.curves)
    for motion in motions[:4]:
        curve, own = response.curves[motion.curve], scene.each_curve()[motion.curve]
        dof = own.modal.dofs.index(motion.of[0])
        assert motion.force.shape == (len(own.contacts), 2, 2)
        assert motion.frequency == pytest.approx(curve.peaks[motion.of[0]].frequency, rel=1e-9)
        if name == "bladed-disk":
            assert motion.modal is None
            continue
        moved = motion.modal.T @ (own.modal.shapes / np.sqrt(own.modal.mass)[:, None])
        assert abs(moved[1, dof]) == pytest.approx(curve.peaks[motion.of[0]].amplitude, rel=1e-5)


def test_a_frequency_with_three_solutions_has_three_motions():
    scene = fcm.load_scene("yang1998-jump").in_use()
    response = trace(scene, harmonics=1)
    curve = next(i for i, one in enumerate(response.curves) if len(one.folds) == 2)
    middle = float(np.mean(response.curves[curve].folds))
    found = [one for one in motions_of(response, scene, [middle]) if one.curve == curve]
    assert len(found) == 3 and sorted(one.stable for one in found) == [0.0, 1.0, 1.0]
    assert {one.frequency for one in found} == {middle}


REFUSED = {
    "needs --mesh": ("--export", "a.vtu"),
    "--mesh is of no use without": ("--mesh", BEAM / "beam.inp"),
    "--motion-at needs one of": ("--motion-at", 4.0),
    "give -o FILE": ("--modal-amplitudes",),
    "--method exact: it writes motions by their harmonics": ("--export", "a.h5", "--method", "exact"),
    "give the forces that amplitude": ("--contact-forces", "f.csv", "--level", "0:2", "--at", 1.2),
    "--motion-at 2: the range is 0.1 to 1 (modal amplitude)": (
        *("--contact-forces", "f.csv", "--mode", 1, "--level", "0.1:1", "--motion-at", 2),
    ),
    "leave --track out": (
        "--export",
        "a.h5",
        "--track",
        "peaks",
        "--over",
        "contact.shroud.n_0",
        "--from",
        1,
        "--to",
        5,
    ),
    "--peaks-only": ("--contact-forces", "f.csv", "--peaks-only"),
    "no degree of freedom is named by a node": ("--export", "a.vtu", "--mesh", BEAM / "beam.inp"),
    "--motion-at 9: the range is": ("--contact-forces", "f.csv", "--motion-at", 9.0),
    "has to end in .vtu or": ("--export", "a.txt"),
}


def test_a_universal_file_needs_rows_of_nodes(tmp_path):
    done = called("respond", "yang1998-n5", "--export", tmp_path / "a.uff")
    assert done.code == 2 and "no degree of freedom is named by a node" in done.err


@pytest.mark.parametrize("said", REFUSED)
def test_what_cannot_be_exported_is_said(said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = called("respond", "yang1998-n5", *REFUSED[said])
    assert done.code == 2 and said in done.err, done.err
    assert not list(tmp_path.iterdir())


def test_a_ring_is_refused(tmp_path):
    done = called("respond", "bladed-disk", "--export", tmp_path / "a.h5")
    assert done.code == 2 and "a ring's sector moves in modes that travel" in done.err


def test_motions_at_an_optimum_are_those_of_the_scene_with_its_numbers(tmp_path):
    span = "[response]\nfrequency = [0.8, 1.6]\nharmonics = 1\n"
    aim = '[optimum]\nvary = ["contact.shroud.n_0"]\nbounds = [[2.0, 20.0]]\nminimise = "peak.u"\n'
    (tmp_path / "best.toml").write_text(oscillator(span, damping=0.05) + aim)
    options = ("--contact-forces", tmp_path / "best.csv", "--export", tmp_path / "best.h5", "--json")
    done = called("respond", tmp_path / "best.toml", *options)
    assert done.code == 0, done.err
    (found,) = json.loads(done.out)["optimum"]
    preload = found["values"]["contact.shroud.n_0"]
    assert abs(preload - 5.0) > 1.0
    (tmp_path / "there.toml").write_text(oscillator(span, 0.05, n_0=preload))
    options = ("--contact-forces", tmp_path / "there.csv", "--export", tmp_path / "there.h5")
    assert called("respond", tmp_path / "there.toml", *options).code == 0
    tables = (tmp_path / f"{name}.csv" for name in ("best", "there"))
    of_best, of_there = (list(csv.DictReader(one.read_text().splitlines())) for one in tables)
    assert len(of_best) == len(of_there) > 4
    for key in ("real", "imag", "frequency [rad/s]"):
        values = [[float(row[key]) for row in rows] for rows in (of_best, of_there)]
        assert values[0] == pytest.approx(values[1], rel=1e-6, abs=1e-6)
    with h5py.File(tmp_path / "best.h5") as one, h5py.File(tmp_path / "there.h5") as other:
        assert one["displacement"][:] == pytest.approx(other["displacement"][:], rel=1e-6)


def test_the_mesh_of_another_structure_is_refused(tmp_path):
    (tmp_path / "model.toml").write_text(SCENE)
    (tmp_path / "xyz.csv").write_text("node,x,y,z\n1,0,0,0\n5,0.1,0,0\n")
    done = called(
        "respond", tmp_path / "model.toml", "--export", tmp_path / "a.vtu", "--mesh", tmp_path / "xyz.csv"
    )
    assert done.code == 2 and "none of the 12 nodes of the structure, which begin with 2, 3, 4" in done.err


STEADY = """*STEP
*FREQUENCY, STORAGE=YES
7
*END STEP
*STEP
*STEADY STATE DYNAMICS
{hertz:.15g}, {above:.15g}, 2, 1.
*MODAL DAMPING
1, 7, {zeta}
*CLOAD
16, 2, {real[0]:.15g}
16, 3, {real[1]:.15g}
*CLOAD, LOAD CASE=2
16, 2, {imag[0]:.15g}
16, 3, {imag[1]:.15g}
*NODE PRINT, NSET=NALL
U
*END STEP
"""


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
def test_calculix_has_the_displacements_under_the_exported_forces(made, tmp_path):
    """Its own steady state, with seven modes: what the others yield is below 1e-4 beside this resonance."""
    folder, _ = made
    rows, waves, _, frequency = waves_of(folder)
    m, forces = 1, forces_of(folder)[1, 0, :, 1]
    load = np.array([40.0 - forces[0], -forces[1]])
    hertz = frequency[m] / (2.0 * np.pi)
    step = STEADY.format(hertz=hertz, above=hertz * (1 + 1e-9), zeta=ZETA, real=load.real, imag=load.imag)
    text = (BEAM / "beam.inp").read_text().split("*STEP")[0]
    (tmp_path / "steady.inp").write_text(text + step)
    assert ended("ccx", "steady", cwd=tmp_path).code == 0
    blocks = (tmp_path / "steady.dat").read_text().split("displacements (vx,vy,vz)")[1:3]
    real, imag = (np.array([line.split() for line in one.splitlines()[2:18]], dtype=float) for one in blocks)
    names = [f"{node}{axis}" for node in range(1, 17) for axis in "xyz"]
    found = np.array([waves[m, 0, rows.index(name)] if name in rows else 0.0 for name in names])
    expected = (real[:, 1:] + 1j * imag[:, 1:]).ravel()
    assert real[:, 0].tolist() == list(range(1, 17))
    assert np.abs(found - expected).max() < 2e-4 * np.abs(expected).max()
