"""``fcm plot loop``: loops of given parameters and of a response file, or one message and exit code 2."""

import json
import re
from dataclasses import replace

import click
import netCDF4
import numpy as np
import pytest

from fcm import load_scene, periodic_forces, periodic_loop, planar_loop
from fcm.cli.loop import _drawn_in_plane, _one_of
from fcm.cli.loop_cases import PlanarCase, of_file
from fcm.cli.loop_names import titles
from fcm.plot import style
from fcm.plot.interface import draw_interface, points_of, read_interface
from fcm.plot.loop_file import PlaceOnCurve
from fcm.plot.normal_force import DrawnNormalForce, draw_normal_force
from fcm.response import trace
from fcm.results.output import write_netcdf
from fcm.scene import scene_from_dict

CONTACT = ("--mu", 0.4, "--k-u", 1, "--k-v", 1, "--n0", 0.8, "--a", 1, "--b", 1)


@pytest.fixture(scope="module")
def folded(tmp_path_factory):
    """The paper's curve at n_0 = 5, which folds, beside one that does not."""
    path = tmp_path_factory.mktemp("loop") / "a.nc"
    scene = load_scene("yang1998")
    write_netcdf(trace(replace(scene, curves=scene.curves[3:5])), path)
    return path


def loops(done):
    assert done.code == 0, done.err
    return json.loads(done.out)["loops"]


@pytest.mark.slow
def test_every_combination_is_drawn_once(fcm, tmp_path):
    args = ("--n0-bar", 0.4, "--n0-bar", 2, "--b-bar", 0.3, "--phi", "20deg", "--phi", 1, "--phi", "20deg")
    found = loops(fcm("plot", "loop", *args, "-o", "a.svg", "--json"))
    assert [(one["n0_bar"], round(one["phi"], 6)) for one in found] == [
        (0.4, 0.349066), (0.4, 1.0), (2.0, 0.349066), (2.0, 1.0),
    ]  # fmt: skip
    assert [one["sequence"] for one in found] == ["EPEN", "EPEN", "E", "E"]
    assert (tmp_path / "a.svg").read_bytes().startswith(b"<?xml")


@pytest.mark.slow
def test_an_angle_of_many_turns_is_asked_about(fcm):
    args = ("plot", "loop", "--n0-bar", 1, "--b-bar", 0.5, "-o", "a.svg")
    assert "--phi 45: is it right? 45 rad are 7.16 turns" in fcm(*args, "--phi", "45").err
    for right in ("45deg", "0.7854", "400deg"):
        assert "is it right" not in fcm(*args, "--phi", right).err


@pytest.mark.slow
def test_a_contact_with_dimensions_is_that_of_its_ratios(fcm):
    scaled = ("--mu", 0.4, "--k-u", 2e4, "--k-v", 1e4, "--n0", 16.0, "--a", 1e-3, "--b", 2e-3)
    (one,) = loops(fcm("plot", "loop", *scaled, "--json", "--units", "m", "N"))
    (other,) = loops(fcm("plot", "loop", *CONTACT, "--json"))
    for key in ("degrees", "displacement", "force"):
        first, second = ([t[key] for t in case["transitions"]] for case in (one, other))
        assert first == pytest.approx(second) and len(first) == 5
    assert (one["n0_bar"], one["b_bar"]) == pytest.approx((0.32, 0.4))
    (ratios,) = loops(fcm("plot", "loop", "--n0-bar", 0.32, "--b-bar", 0.4, "--json"))
    assert ratios["sequence"] == other["sequence"]


def test_parameters_and_axes_have_the_units_that_are_given(fcm, tmp_path):
    harmonic = ("--harmonic", "v", 2, 0.3, "20deg", "--units", "mm", "N")
    done = fcm("plot", "loop", *CONTACT, *harmonic, "-o", "a.svg")
    said = "mu = 0.4, k_u = 1 N/mm, k_v = 1 N/mm, n_0 = 0.8 N, a = 1 mm, b = 1 mm, phi = 45°, v_2 = 0.3 mm at"
    assert f"{said} 20°" in done.err
    drawn = (tmp_path / "a.svg").read_text(encoding="utf-8")  # what is written is beside its outlines
    assert "$k_u$ = 1 N/mm" in drawn and "= 0.3 mm at 20°" in drawn and "<!-- Force (N) -->" in drawn


@pytest.mark.slow
def test_a_file_has_the_units_of_its_scene(fcm, tmp_path):
    scene, path = load_scene("yang1998-n5"), tmp_path / "a.nc"
    write_netcdf(replace(trace(scene), units=("mm", "N")), path)
    assert fcm("plot", "loop", path, "-o", "a.svg").code == 0
    assert "<!-- Displacement $u$ (mm) -->" in (tmp_path / "a.svg").read_text(encoding="utf-8")


def test_harmonics_of_the_motion(fcm, tmp_path):
    """u = a sin(theta) + 0.6 sin(3 theta + 20deg) and so on; the same by the forces of that motion."""
    scaled = ("--mu", 0.4, "--k-u", 2.0, "--k-v", 1.5, "--n0", 0.6, "--a", 1.5, "--b", 1.2, "--phi", "30deg")
    harmonics = ("--harmonic", "u", 3, 0.6, "20deg", "--harmonic", "v", 2, 0.3, 0.5)
    (one,) = loops(fcm("plot", "loop", *scaled, *harmonics, "--json", "-o", "a.svg"))
    assert (tmp_path / "a.svg").read_bytes().startswith(b"<?xml")
    assert [tuple(h.values()) for h in one["harmonics"]] == [
        ("u", 3, 0.6, pytest.approx(np.radians(20.0))), ("v", 2, 0.3, 0.5),
    ]  # fmt: skip
    u = -1j * np.array([0.0, 1.5, 0.0, 0.6 * np.exp(1j * np.radians(20.0))])
    v = -1j * np.array([0.0, 1.2 * np.exp(1j * np.radians(30.0)), 0.3 * np.exp(0.5j)])
    f, _ = periodic_forces(u, v, 0.4, 2.0, 1.5, 0.6)
    known = periodic_loop(u, v, 0.4, 2.0, 1.5, 0.6)
    assert (one["F_b"], one["F_s"], one["F_c"]) == pytest.approx(
        (f[0].real / 3.0, -f[1].imag / 3.0, f[1].real / 3.0), abs=1e-14
    )
    assert one["sequence"] == known.sequence
    found = one["transitions"]
    assert [t["degrees"] for t in found] == pytest.approx(np.degrees(known.angles), abs=1e-9)
    assert [t["force"] for t in found] == pytest.approx(known.force(known.angles) / 3.0, abs=1e-12)


@pytest.mark.slow
def test_a_harmonic_of_no_amplitude_changes_nothing(fcm):
    (plain,) = loops(fcm("plot", "loop", *CONTACT, "--json"))
    (other,) = loops(fcm("plot", "loop", *CONTACT, "--harmonic", "u", 5, 0, 0, "--json"))
    assert other["sequence"] == plain["sequence"]
    for key in ("degrees", "displacement", "force"):
        first, second = ([t[key] for t in case["transitions"]] for case in (plain, other))
        assert second == pytest.approx(first, abs=1e-10)


@pytest.mark.slow
def test_the_angle_may_begin_at_the_greatest_displacement(fcm):
    sine, cosine = (loops(fcm("plot", "loop", "--json", *more))[0] for more in ((), ("--cosine",)))
    turned = [(one["degrees"] - 90.0) % 360.0 for one in sine["transitions"]]
    assert [one["degrees"] for one in cosine["transitions"]] == pytest.approx(turned)


@pytest.mark.slow
def test_all_solutions_of_a_folded_curve(fcm, folded):
    done = fcm("plot", "loop", folded, "--curve", 1, "--at", 1.2, "--json")
    found = loops(done)
    assert [(one["solution"], one["solutions"], one["stable"]) for one in found] == [
        (1, 3, True), (2, 3, False), (3, 3, True),
    ]  # fmt: skip
    assert found[0]["a"] > found[1]["a"] > found[2]["a"]
    assert all(abs(one["frequency"] - 1.2) < 0.01 for one in found)
    assert "rad/s, 2 of 3, unstable: SPEN" in done.err
    with netCDF4.Dataset(folded) as data:  # the loops are those of the file's regimes
        frequency, regime = data["frequency"][1], data["regime"][1, :, 0]
        for one in found:
            assert regime[np.argmin(np.abs(frequency - one["frequency"]))] == one["sequence"]


@pytest.mark.slow
def test_loops_of_levels_are_named_by_their_level(fcm, tmp_path):
    """Between the folds, at the levels 0.90 and 1.39, there are three; at the peak the level is the last."""
    path = tmp_path / "level.nc"
    given = ("yang1998-n5", "--level", "0:2", "--at", "1.2", "--harmonics", "1")
    assert fcm("respond", *given, "-o", path).code == 0
    found = loops(fcm("plot", "loop", path, "--at", "1.2", "--json"))
    assert [one["level"] for one in found] == pytest.approx([1.2] * 3, rel=0.05)
    done = fcm("plot", "loop", path, "-o", tmp_path / "b.png")
    assert re.findall(r" level ([\d.]+),", done.err) == ["2"]


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    path = tmp_path_factory.mktemp("three") / "three.nc"
    write_netcdf(trace(replace(load_scene("yang1998-n5"), harmonics=(1, 2, 3))), path)
    return path


def _turned(word):
    return {word[i:] + word[:i] for i in range(len(word))}


@pytest.mark.slow
@pytest.mark.parametrize("at", [1.1, 1.16, 1.25])
def test_the_loop_of_several_harmonics_is_that_of_the_whole_motion(fcm, three, at):
    """Its states are those of the file, and its force has the harmonics of the one that marching finds."""
    done = fcm("plot", "loop", three, "--at", at, "--json", "-o", three.with_name("a.png"))
    found = loops(done)
    assert "fundamental alone" not in done.err and "events located exactly" in done.err
    with netCDF4.Dataset(three) as data:
        for one in found:
            k = np.nanargmin(np.abs(data["frequency"][0].filled(np.nan) - one["frequency"]))
            assert one["states"] == data["regime"][0, k, 0]
            assert one["sequence"] in _turned(one["states"])
            mu, k_u, k_v, n_0 = (float(data[f"contact_{name}"][0, 0]) for name in ("mu", "k_u", "k_v", "n_0"))
            scale, phase = (data[f"contact_{name}"][0, k, 0] for name in ("amplitude", "phase"))
            v_0 = float(data["contact_mean"][0, k, 0, 1])
            theta = np.arange(4 * 20000) * 2.0 * np.pi / 20000
            u, v = (
                sum(scale[d, h] * np.sin((h + 1) * theta + phase[d, h]) for h in range(3)) for d in (0, 1)
            )
            limit, w, force = mu * np.maximum(n_0 + k_v * (v_0 + v), 0.0), 0.0, []
            for displacement, most in zip(u.tolist(), limit.tolist(), strict=True):
                w = min(max(w, displacement - most / k_u), displacement + most / k_u)
                force.append(k_u * (displacement - w))
            by_sine = 2.0 * np.mean(np.array(force[-20000:]) * np.sin(theta[-20000:] + phase[0, 0]))
            assert one["F_s"] * one["k_u a"] == pytest.approx(by_sine, rel=1e-2, abs=1e-3 * one["k_u a"])


def test_a_file_without_the_harmonics_of_contacts_has_the_loop_of_the_fundamental(fcm, three, tmp_path):
    """As files of before have; it is said."""
    old = tmp_path / "old.nc"
    with netCDF4.Dataset(three) as data, netCDF4.Dataset(old, "w") as copy:
        copy.setncatts({name: data.getncattr(name) for name in data.ncattrs()})
        for name, dimension in data.dimensions.items():
            copy.createDimension(name, dimension.size)
        for name, one in data.variables.items():
            if not name.startswith("contact_"):
                copy.createVariable(name, one.dtype, one.dimensions)[:] = one[:]
    done = fcm("plot", "loop", old, "--at", 1.16, "--json")
    (one,) = loops(done)
    assert "fundamental alone of harmonics 1-3" in done.err and "from the closed form" in done.err
    assert one["harmonics"] == [1, 2, 3] and one["states"] != ""


def test_one_of_them(fcm, folded):
    (one,) = loops(fcm("plot", "loop", folded, "--curve", 1, "--at", 1.2, "--solution", 2, "--json"))
    assert one["solution"] == 2 and not one["stable"]


@pytest.mark.slow
def test_the_contacts_have_the_same_solutions_with_their_number_in_text_and_picture(fcm, folded):
    """One of several was drawn, and nothing said so."""
    at = ("--curve", 1, "--at", 1.2)
    found = loops(fcm("plot", "loop", folded, *at, "--json"))
    done = fcm("plot", "contacts", folded, *at, "-o", "c.png")
    heads = re.findall(r"at ([0-9.]+) rad/s, (\d) of 3", done.err)
    assert done.code == 0 and "2 of 3, unstable, curve 1" in done.err
    assert heads == [(f"{one['frequency']:.6g}", str(one["solution"])) for one in found]
    read = read_interface(folded)
    titles = [axes.get_title() for axes in draw_interface(read, points_of(read, (1.2,), 1)).axes[:3]]
    assert ["1 of 3" in one for one in titles] == [True, False, False] and "3 of 3" in titles[2]
    (second,) = points_of(read, (1.2,), 1, solution=2)
    assert second.solution.number == 2 and second.frequency == found[1]["frequency"]
    done = fcm("plot", "contacts", folded, *at, "--solution", 4)
    assert done.code == 2 and "--solution 4: the curve has 3 solutions at 1.2" in done.err
    done = fcm("plot", "contacts", folded, *at, "--at", 1.21, "--at", 1.19)
    assert "9 points by --at are too many: a picture has room for 6; --solution 1 takes one" in done.err


OUTPUT = """
modal = { dofs = ["u", "v"], frequency = [1, 2], damping = [0.02, 0.02], shapes = [[1, 0.05], [-0.05, 1]] }
force = [{ dof = "u", amplitude = 1.0 }, { dof = "v", amplitude = 1.0 }]
contact = [{ name = "pad", tangential = "u", normal = "v", mu = 0.4, k_u = 0.2, k_v = 0.1, n_0 = 3.0 }]
units = { length = "mm", force = "N" }
[response]
frequency = [0.7, 2.5]
harmonics = 1
"""


@pytest.mark.slow
@pytest.mark.parametrize("output", [(), ("v",)])
def test_without_a_frequency_it_is_the_peak_of_the_output_and_named_so(fcm, tmp_path, output):
    """The contact moves most at the peak of u; the peak of v is elsewhere."""
    (tmp_path / "a.toml").write_text(
        OUTPUT + (f"output = {list(output)}\n".replace("'", '"') if output else "")
    )
    assert fcm("respond", "a.toml", "-o", "a.nc").code == 0
    done = fcm("plot", "loop", "a.nc", "--json", "-o", "a.svg")
    (one,) = loops(done)
    with netCDF4.Dataset(tmp_path / "a.nc") as data:
        amplitude, omega = data["amplitude"][0].filled(np.nan), data["frequency"][0].filled(np.nan)
        names = data["dof"][:].tolist()
    dof = "v" if output else "u"
    top = amplitude[:, names.index(dof)]
    assert one["frequency"] == omega[np.nanargmax(top)]
    assert (one["output"], one["output_amplitude"], one["peak"]) == (dof, np.nanmax(top), True)
    assert f"peak of {dof} = {np.nanmax(top):.4g} mm, {one['frequency']:.5g} rad/s" in done.err
    peaks = {name: omega[np.nanargmax(amplitude[:, names.index(name)])] for name in "uv"}
    assert abs(peaks["u"] - peaks["v"]) > 0.5
    chosen = fcm("plot", "contacts", "a.nc", "-o", "b.svg").err
    assert f"at {one['frequency']:.6g} rad/s; 1 contact" in chosen


@pytest.mark.slow
def test_without_a_frequency_it_is_the_peak(fcm, folded, tmp_path):
    found = loops(fcm("plot", "loop", folded, "--curve", 0, "--curve", 1, "--json", "-o", "a.png"))
    assert [one["a"] for one in found] == pytest.approx([6.236, 15.83], rel=1e-3)
    assert [one["parameters"]["contact.shroud.n_0"] for one in found] == [10.0, 5.0]


@pytest.mark.slow
def test_the_picture_is_beside_the_file(fcm, folded):
    assert fcm("plot", "loop", folded, "--curve", 0, "--dimensionless").code == 0
    assert folded.with_name("a-loop.png").is_file()


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (("--n0-bar", "nan"), "nan is not between"),
        (("--b-bar", -1), "-1 is not between 0"),
        (("--phi", "15grad"), "is no angle"),
        (CONTACT[:6], "--n0, --a, --b missing"),
        (("--a", 1), "--mu, --k-u, --k-v, --n0, --b missing"),
        ((*CONTACT, "--mu", 0), "0 is not above 0"),
        ((*CONTACT, "--b", -1), "-1 is not at least 0"),
        ((*CONTACT, "--n0", "inf"), "inf is not a finite number"),
        ((*CONTACT, "--n0-bar", 1), "--n0-bar is of no use beside"),
        ((*CONTACT, "--k-u", 1e-300, "--a", 1e-300), "have to be finite"),
        (("--at", 1), "--at is of no use without a FILE"),
        (("--harmonic", "u", 3, 1, 0), "--harmonic is of no use without --mu"),
        ((*CONTACT, "--harmonic", "w", 3, 1, 0), '"w" is not one of "u", "v"'),
        ((*CONTACT, "--harmonic", "u", 1, 1, 0), "1 is not in the range"),
        ((*CONTACT, "--harmonic", "u", 2, -1, 0), "-1 is no amplitude"),
        ((*CONTACT, "--harmonic", "u", 2, "nan", 0), "nan is no amplitude"),
        ((*CONTACT, "--harmonic", "u", 2, 1, "north"), '"north" is no angle'),
        ((*CONTACT, *2 * ("--harmonic", "v", 2, 1, 0)), "harmonic 2 of v is given twice"),
        ((*CONTACT, "--harmonic", "u", 2, 1e300, 0, "--a", 1e-30, "--k-u", 1e30), "amplitudes / a"),
        (("--units", "m", "N"), "the axes have no dimension"),
        (("--n0-bar", 1, *(x for phi in range(13) for x in ("--phi", phi))), "13 loops are too many"),
        (("-o", "a.txt"), "has to end in"),
        (("-o", "."), "it is this folder"),
        (("--at", 1, "--contact", "c", "--units", "m", "N"), "--at, --contact are of no use without a FILE"),
        (("--at", 1, "--units", "m", "N"), "--units is of no use: the axes have no dimension; --at is"),
        (
            (*CONTACT[:4], "--curve", 2, "--n0-bar", 1),
            "--curve is of no use without a FILE; --n0-bar is of no",
        ),
        (
            ("--mu", 1, "--b-bar", 1),
            "and --b; the contact is not complete: --k-u, --k-v, --n0, --a, --b missing",
        ),
    ],
)
def test_nonsense_is_said(fcm, tmp_path, args, said):
    done = fcm("plot", "loop", *args)
    assert done.code == 2 and said in done.err and done.out == ""
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("args", "said"),
    [
        ((), "has 2 curves; say which by --curve 0 to --curve 1"),
        (("--curve", 2), "there is no curve 2; it has 2 curves, numbers 0 to 1"),
        (("--curve", 0, "--at", 3), "curve 0 goes from 0.7 to 1.7 rad/s, not to 3"),
        (("--curve", 0, "--contact", "blade"), 'there is no contact "blade"; it has "shroud"'),
        (("--curve", 0, "--at", 1, "--solution", 2), "--solution 2: the curve has 1 solution at 1"),
        (("--curve", 0, "--phi", 1), "--phi is of no use with a FILE"),
        (("--curve", 0, "--harmonic", "u", 2, 1, 0), "--harmonic is of no use with a FILE"),
    ],
)
def test_what_the_file_has_not_is_said(fcm, folded, args, said):
    done = fcm("plot", "loop", folded, *args)
    assert done.code == 2 and said in done.err and done.out == ""


@pytest.mark.slow
def test_of_many_contacts_that_which_takes_most_energy_is_drawn(fcm, folded, tmp_path):
    """A hundred made of the one: the energy of each is another part of its own."""
    share = np.random.default_rng(3).permutation(100) + 1.0
    with netCDF4.Dataset(folded) as one, netCDF4.Dataset(tmp_path / "many.nc", "w") as many:
        many.setncatts({key: one.getncattr(key) for key in one.ncattrs()})
        for name, dimension in one.dimensions.items():
            many.createDimension(name, 100 if name == "contact" else len(dimension))
        for name, own in one.variables.items():
            made = many.createVariable(name, own.dtype, own.dimensions)
            made.setncatts({key: own.getncattr(key) for key in own.ncattrs() if key != "_FillValue"})
            values = own[:]
            if "contact" in own.dimensions:
                values = np.repeat(values, 100, axis=own.dimensions.index("contact"))
            if name == "contact":
                values = np.array([f"pair {i}" for i in range(100)], dtype=object)
            made[:] = values * share if name == "dissipated_energy" else values
    done = fcm("plot", "loop", "many.nc", "--curve", 0)
    first, *others = (f"pair {i}" for i in np.argsort(-share)[:11])
    assert done.code == 0 and done.err.startswith(
        f"{first} of 100 contacts takes most energy in a cycle; --contact NAME takes another: "
        f"{', '.join(others)}, ...\n"
    )
    assert f"{first}, " in done.err.splitlines()[1]
    done = fcm("plot", "loop", "many.nc", "--curve", 0, "--contact", "pair 7")
    assert done.code == 0 and "takes most energy" not in done.err


@pytest.mark.slow
def test_letters_that_the_fonts_lack_are_said_once(fcm, folded, tmp_path):
    (tmp_path / "named.nc").write_bytes(folded.read_bytes())
    with netCDF4.Dataset(tmp_path / "named.nc", "a") as data:
        data["contact"][0] = "叶片"
    done = fcm("plot", "loop", "named.nc", "--curve", 0)
    assert done.code == 0 and (tmp_path / "named-loop.png").exists()
    assert [line for line in done.err.splitlines() if "wrote" not in line and "stable" not in line] == [
        'fcm: warning: named-loop.png: the fonts lack "叶", "片", which are boxes in the picture'
    ]


@pytest.mark.slow
def test_a_file_without_loops(fcm, folded, tmp_path):
    (tmp_path / "b.nc").write_bytes(folded.read_bytes())
    with netCDF4.Dataset(tmp_path / "b.nc", "a") as data:
        data.renameVariable("phi", "psi")
    done = fcm("plot", "loop", "b.nc")
    assert (done.code, done.err) == (2, "fcm: error: b.nc: holds no loops: it has no variable phi\n")
    with netCDF4.Dataset(tmp_path / "b.nc", "a") as data:
        data.renameVariable("psi", "phi")
        loops = {name: data[name][:] for name in ("n0_bar", "b_bar", "tangential_amplitude")}
        data["n0_bar"][:] = data["b_bar"][:] = 0.0
    said = fcm("plot", "loop", "b.nc", "--curve", 0).err
    assert "has no friction, and so no loop, and the file has not its normal motion" in said
    with netCDF4.Dataset(tmp_path / "b.nc", "a") as data:
        for name, values in loops.items():
            data[name][:] = 0.0 if name == "tangential_amplitude" else values
    assert "no tangential motion at 0.7 rad/s" in fcm("plot", "loop", "b.nc", "--curve", 0, "--at", 0.7).err
    said = fcm("plot", "loop", "b.nc", "--curve", 0).err
    assert "that is the peak of u; choose another by --at" in said
    with netCDF4.Dataset(tmp_path / "b.nc", "a") as data:
        data["tangential_amplitude"][:] = np.nan
    assert "exact motions" in fcm("plot", "loop", "b.nc", "--curve", 0).err


IN_PLANE = """
[modal]
dofs = ["x", "y", "z"]
mass = [1.0, 1.0, 1.0]
frequency = [1.0, 1.3, 2.0]
damping = [0.05, 0.05, 0.05]
shapes = [[1.0, 0.2, 0.1], [-0.2, 1.0, 0.3], [0.1, -0.3, 1.0]]
[[contact]]
name = "pad"
tangential = ["x", { y = -1.0 }]
normal = "z"
mu = 0.5
k_u = 1.0
k_v = 1.0
n_0 = 1.0
[[force]]
dof = "x"
amplitude = 1.0
[[force]]
dof = "y"
amplitude = 0.6
phase = 1.0
[response]
frequency = [0.95, 1.05]
harmonics = 1
"""


@pytest.mark.slow
def test_a_contact_in_a_plane_of_a_file(fcm, tmp_path):
    (tmp_path / "plane.toml").write_text(IN_PLANE, encoding="utf-8")
    told = fcm("respond", "plane.toml", "-o", "plane.nc", "--csv", "plane.csv", "--json")
    assert json.loads(told.out)["directions"] == {"pad": {"x": "x", "y": "-y", "normal": "z"}}
    head, first = (tmp_path / "plane.csv").read_text(encoding="utf-8").splitlines()[:2]
    row = dict(zip(head.split(","), first.split(","), strict=True))
    assert float(row["friction_x pad"]) > 0.0
    assert set(row["regime pad"]) <= set("EPS")
    done = fcm("plot", "loop", "plane.nc", "--at", "1.0", "-o", "plane.png", "--json")
    assert done.code == 0
    (one,) = json.loads(done.out)["loops"]
    assert one["directions"] == {"x": "x", "y": "-y"}
    assert one["sequence"] == one["states"]
    assert len(one["transitions"]) == len(one["sequence"])
    assert (tmp_path / "plane.png").stat().st_size > 10_000
    assert f"pad, {one['frequency']:.5g} rad/s, stable: {one['sequence']}" in done.err


@pytest.mark.slow
def test_several_loops_in_a_plane_are_too_many(fcm, tmp_path):
    (tmp_path / "plane.toml").write_text(IN_PLANE, encoding="utf-8")
    fcm("respond", "plane.toml", "-o", "plane.nc")
    done = fcm("plot", "loop", "plane.nc", "--at", "0.97", "--at", "1.0")
    assert done.code == 2
    assert "2 loops in a plane are too many for a picture: give --at once." in done.err
    folded = {"curves": (), "at": (470.0,), "amplitudes": ()}
    assert _one_of(folded) == "the curve is folded there; take one solution, as by --solution 1"
    done = fcm("plot", "loop", "plane.nc", "--cosine")
    assert done.code == 2 and "--cosine is of no use in a plane" in done.err


def test_a_loop_in_a_plane_without_dimensions():
    loop = planar_loop([0.0, 3.0], [0.0, 1.0 - 2.0j], [0.0, 2.0], 0.3, 5.0, 2.0, 7.0)
    case = PlanarCase(loop, ("x", "y"), (), "", {"a": 2.0, "k_u a": 10.0}, None)
    theta, scaled = np.linspace(0.0, 6.0, 41), case.dimensionless()
    assert scaled.force(theta) == pytest.approx(loop.force(theta) / 10.0, abs=1e-9)
    assert scaled.displacement(theta) == pytest.approx(loop.displacement(theta) / 2.0, abs=1e-12)
    still = PlanarCase(loop, ("x", "y"), (), "", {"a": 0.0, "k_u a": 0.0}, None)
    with pytest.raises(click.UsageError, match="the motion in the plane is zero"):
        still.dimensionless()
    figure = _drawn_in_plane(replace(case, note="1 of 3, stable"), True, None)
    assert figure.get_suptitle() == f"1 of 3, stable, {loop.sequence}"


@pytest.mark.slow
def test_a_point_beside_the_frequency_asked_for_is_said(fcm, folded):
    """It was drawn as if it were there."""
    done = fcm("plot", "loop", folded, "--curve", 0, "--at", 1.2, "--json")
    (one,) = loops(done)
    assert one["frequency"] != 1.2
    assert f"at 1.2: drawn is the nearest point of the file, at {one['frequency']:.6g} rad/s" in done.err
    again = fcm("plot", "loop", folded, "--curve", 0, "--at", repr(one["frequency"]), "--json")
    assert "nearest point" not in again.err


def test_the_title_of_a_loop_beside_the_frequency_asked_for_has_both(folded):
    (beside,) = of_file(folded, [0], None, [PlaceOnCurve(1.3)], None, print)
    at = beside.facts["frequency"]
    common, _ = titles([beside])
    assert at != 1.3 and common.endswith(f"= {at:.5g} rad/s\nasked: 1.3 rad/s")
    (there,) = of_file(folded, [0], None, [PlaceOnCurve(at)], None, print)
    assert "asked" not in titles([there])[0]


@pytest.mark.slow
def test_a_modal_amplitude_beside_that_asked_for_has_no_unit_of_frequency(fcm):
    run = ("--mode", 1, "--level", "0.1:100", "--harmonics", 1, "-o", "mode.nc")
    assert fcm("respond", "yang1998-n5", *map(str, run)).code == 0
    done = fcm("plot", "loop", "mode.nc", "--amplitude", "3", "--json")
    (one,) = json.loads(done.out)["loops"]
    nearest = f"{one['modal_amplitude']:.6g}"
    assert f"at 3: drawn is the nearest point of the file, at {nearest}. A smaller" in done.err


STOP = {
    "modal": {
        "dofs": ["x", "y"],
        "frequency": [1.0, 2.0],
        "damping": 0.02,
        "shapes": [[1.0, 0.5], [-0.5, 1.0]],
    },
    "contact": [
        {"name": "stop", "tangential": "y", "normal": "x", "mu": 0.0, "k_u": 0.0, "k_v": 0.5, "gap": 2.0}
    ],
    "force": [{"dof": "x", "amplitude": 0.2}],
    "response": {"frequency": [0.8, 1.4]},
    "units": {"length": "mm", "force": "N"},
}


@pytest.mark.slow
@pytest.mark.parametrize("harmonics", [1, 3])
def test_of_a_contact_without_friction_the_normal_force_is_drawn(fcm, tmp_path, harmonics):
    """It was refused."""
    path = tmp_path / "stop.nc"
    write_netcdf(trace(scene_from_dict(STOP), harmonics=harmonics), path)
    done = fcm("plot", "loop", path, "--json")
    (one,) = loops(done)
    assert (tmp_path / "stop-loop.png").exists() and "no friction; normal force up to" in done.err
    with netCDF4.Dataset(path) as data:
        k = np.nanargmin(np.abs(data["frequency"][0].filled(np.nan) - one["frequency"]))
        assert one["greatest_normal_force"] == pytest.approx(data["greatest_normal_force"][0, k, 0])
        amplitude, phase = (data[f"harmonic_{name}"][0, k, :, 0] for name in ("amplitude", "phase"))
        orders, mean = data["harmonic"][:], float(data["mean"][0, k, 0])
    assert sorted(one["sequence"]) == ["closed", "open"] and one["least_normal_force"] == 0.0

    def n(degrees):
        return 0.5 * (mean + sum(amplitude * np.sin(orders * np.radians(degrees) + phase))) - 1.0

    for transition in one["transitions"]:
        after = 1.0 if transition["to"] == "closed" else -1.0
        assert n(transition["degrees"]) == pytest.approx(0.0, abs=1e-6)
        assert n(transition["degrees"] + 1.0) * after > 0.0 > n(transition["degrees"] - 1.0) * after
    done = fcm("plot", "loop", path, "--cosine", "--dimensionless")
    assert (
        done.code == 2 and "--cosine, --dimensionless are of no use: the contact has no friction" in done.err
    )


def test_the_picture_of_a_normal_force_has_it_over_displacement_and_angle():
    v = [0.5, -2.0j, 0.0, 0.3]
    cycle = periodic_loop([0.0], v, 1.0, 1.0, 4.0, -2.0)
    above, below = draw_normal_force(DrawnNormalForce(cycle, "a stop", ("mm", "N"))).axes
    assert (above.get_xlabel(), above.get_ylabel()) == (
        "Normal displacement $v$ (mm)",
        "Normal force $n$ (N)",
    )

    def at(theta):
        return sum((x * np.exp(1j * h * theta)).real for h, x in enumerate(v))

    displacement = at(np.linspace(0.0, 2.0 * np.pi, 100_000))
    lines = [line for line in above.lines if line.get_label() in ("open", "closed")]
    drawn = np.concatenate([line.get_xydata() for line in lines])
    assert np.allclose(drawn[:, 1], np.maximum(4.0 * drawn[:, 0] - 2.0, 0.0), atol=1e-12)
    ends = [drawn[:, 0].min(), drawn[:, 0].max()]
    assert ends == pytest.approx([displacement.min(), displacement.max()], rel=1e-4)
    over = np.concatenate([line.get_xydata() for line in below.lines if len(line.get_xdata()) > 2])
    over = over[(over[:, 0] >= 0.0) & (over[:, 0] <= 360.0)]
    told = np.maximum(4.0 * at(np.radians(over[:, 0])) - 2.0, 0.0)
    assert np.allclose(over[:, 1], told, atol=1e-12) and np.ptp(over[:, 0]) > 359.0
    (ring,) = (line for line in above.lines if line.get_marker() == "o")
    assert ring.get_xydata().ravel().tolist() == pytest.approx([0.5, 0.0])
    (text,) = (text.get_text() for text in above.texts)
    assert text.count("opens at") == text.count("closes at") == cycle.sequence.count("S")


@pytest.mark.slow
def test_of_several_curves_one_is_to_be_named(fcm, folded, monkeypatch):
    """`loop` first said which contact it takes; `contacts` draws all that a picture has room for."""
    picture = folded.with_name("several.png")
    done = fcm("plot", "loop", folded, "-o", picture)
    assert done.code == 2 and not picture.exists()
    assert done.err.strip().endswith("has 2 curves; say which by --curve 0 to --curve 1")
    done = fcm("plot", "contacts", folded, "-o", picture)
    assert done.code == 0 and picture.exists()
    assert all(f", curve {k} (" in done.err for k in (0, 1))
    monkeypatch.setattr(style, "LAYOUT", replace(style.LAYOUT, panels=1))
    done = fcm("plot", "contacts", folded)
    assert done.code == 2 and done.err.strip().endswith("say which by --curve 0 to --curve 1")
