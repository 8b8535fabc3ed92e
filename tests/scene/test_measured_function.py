"""What a universal file says of its function: layout, place, quantity and units, beside the scene."""

import numpy as np
import pytest

from fcm.model.question import Question
from fcm.plot.errors import PlotError
from fcm.plot.measured import read_measured_points
from fcm.scene import SceneError
from fcm.scene.load import scene_from_dict

VALUES = (1.0 + 0.5j, 0.0 - 2.0j, -0.25 + 0.125j, 3.0 + 4.0j, -0.5 - 0.5j)
HERTZ = np.array([10.0, 10.5, 11.0, 11.5, 13.0])
SINGLE, DOUBLE = "{:13.5E}".format, "{:20.12E}".format


def layout(points, each, per_line):
    """Lines of points (x, y) or (x, re, im), each number written as its place has it."""
    words = ["".join(write(number) for write, number in zip(each, point, strict=True)) for point in points]
    return ["".join(words[i : i + per_line]) for i in range(0, len(words), per_line)]


def uff(
    values=VALUES,
    *,
    kind=6,
    rows=None,
    function=4,
    response=("NONE", 3, 1),
    reference=("NONE", 1, 1),
    abscissa=(18, "Hz"),
    ordinate=(8, "NONE"),
    denominator=(13, "NONE"),
    system=None,
):
    """A universal file with a dataset 58; system: the factors of length and force of a dataset 164."""
    places = "".join(
        f" {name:<10}{node:10d}{direction:4d}" for name, node, direction in (response, reference)
    )
    head = ["NONE"] * 5 + [f"{function:5d}{0:10d}{0:5d}{0:10d}{places}"]
    head += [f"{kind:10d}{len(values):10d}{0:10d}{0.0:13.5E}{0.0:13.5E}{0.0:13.5E}"]
    axes = (abscissa, ordinate, denominator, (0, "NONE"))
    head += [f"{one:10d}{0:5d}{0:5d}{0:5d} {'NONE':<20} {unit:<20}" for one, unit in axes]
    if rows is None:
        points = [(x, y.real, y.imag) for x, y in zip(HERTZ, values, strict=True)]
        rows = layout(points, (SINGLE, DOUBLE, DOUBLE), 1)
    units = []
    if system is not None:
        units = ["    -1", "   164", f"{9:10d}{'of one:s own':<20}{2:10d}"]
        units += [
            "".join(f"{x:25.17E}".replace("E", "D") for x in (*system, 1.0)),
            f"{273.15:25.17E}",
            "    -1",
        ]
    return "\n".join([*units, "    -1", "    58", *head, *rows, "    -1", ""])


@pytest.fixture
def read(tmp_path):
    """The measurement of a scene of three nodes and a universal file, and what is said of the fit."""

    def loaded(text, *, units=None, force=None, base=None, **data):
        (tmp_path / "a.unv").write_text(text, encoding="utf-8")
        stiffness = [[2.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]]
        scene = {
            "frequency_unit": "Hz",
            "structure": {"dofs": ["1x", "3x", "tip"], "mass": np.eye(3).tolist(), "stiffness": stiffness,
                          "damping": 0.01},
            "contact": [{"name": "c", "tangential": "3x", "normal": "tip", "mu": 0.3, "n_0": 1.0,
                         "k_u": 1.0, "k_v": 1.0}],
            "force": [{"dof": "1x", "amplitude": 1.0} | (force or {})],
            "response": {"frequency": [5.0, 20.0], "output": ["1x", "3x", "tip"]},
            "fit": {"vary": ["contact.c.mu"], "data": [{"file": "a.unv", "dof": "3x", **data}]},
        }  # fmt: skip
        scene |= {"units": units} if units else {}
        if base:
            del scene["force"]
            scene["base"] = base
        found = scene_from_dict(scene, folder=tmp_path)
        return found.fit.data[0], [note for note in found.notes if note.startswith("fit:")]

    return loaded


def complex_of(one):
    return one.amplitude * np.exp(1j * one.phase)


@pytest.mark.parametrize(
    ("kind", "each", "per_line"),
    [
        (5, (SINGLE, SINGLE, SINGLE), 2),
        (5, (SINGLE, SINGLE, SINGLE), 1),
        (6, (SINGLE, DOUBLE, DOUBLE), 1),
        (2, (SINGLE, SINGLE), 3),
        (2, (SINGLE, SINGLE), 1),
        (4, (SINGLE, DOUBLE), 2),
        (4, (SINGLE, DOUBLE), 1),
    ],
)
@pytest.mark.parametrize("power", [0, -100])
def test_uneven_frequencies_in_the_lines_of_the_standard(read, kind, each, per_line, power):
    """Several points share a line; negative numbers of three digits' exponent touch their neighbours."""
    values = 10.0**power * np.array(VALUES) if len(each) == 3 else 10.0**power * np.abs(VALUES)
    parts = (lambda y: (y.real, y.imag)) if len(each) == 3 else (lambda y: (y,))
    points = [(x, *parts(y)) for x, y in zip(HERTZ, values.tolist(), strict=True)]
    one, _ = read(uff(values, kind=kind, rows=layout(points, each, per_line)))
    assert one.frequency == pytest.approx(2.0 * np.pi * HERTZ, rel=1e-6)
    if len(each) == 3:
        assert complex_of(one) == pytest.approx(values, rel=1e-5)
    else:
        assert one.phase is None and one.amplitude == pytest.approx(values, rel=1e-5)


def test_real_values_of_both_signs_are_no_amplitudes(read):
    rows = layout([(10.0, 1.0), (11.0, -1.0)], (SINGLE, SINGLE), 3)
    with pytest.raises(SceneError, match="its values are real, and some are negative"):
        read(uff((1.0, -1.0), kind=2, rows=rows))


@pytest.mark.parametrize(
    ("response", "reference", "sign"), [(1, 1, 1), (-1, 1, -1), (1, -1, -1), (-1, -1, 1)]
)
def test_a_direction_against_the_axis_turns_the_sign(read, response, reference, sign):
    one, said = read(uff(response=("NONE", 3, response), reference=("NONE", 1, reference)))
    assert complex_of(one) == pytest.approx(sign * np.array(VALUES)) and not said


def test_a_reference_of_a_spectrum_turns_no_sign(read):
    one, _ = read(uff(function=12, reference=("NONE", 7, -2), denominator=(0, "NONE")))
    assert complex_of(one) == pytest.approx(np.array(VALUES))


@pytest.mark.parametrize(
    ("force", "factor"),
    [
        ({"amplitude": -2.0}, -2.0),
        ({"dof": {"1x": -3.0}, "amplitude": 2.0}, -6.0),
        ({"amplitude": 2.0, "phase": np.pi / 2}, 2.0j),
    ],
)
def test_a_frequency_response_function_is_that_to_the_force_as_it_acts(read, force, factor):
    one, _ = read(uff(), force=force)
    assert complex_of(one) == pytest.approx(factor * np.array(VALUES))


def test_another_place_is_asked_about(read):
    _, said = read(uff(response=("NONE", 3, 2), reference=("NONE", 4, 1)))
    assert all(isinstance(one, Question) for one in said)
    response, force = said
    assert response.startswith("fit: a.unv has the response at 3y, and the measurement is at 3x")
    assert force.startswith("fit: a.unv has a force at 4x, and the force of the scene is at 1x")


@pytest.mark.parametrize(("name", "asked"), [("3x", True), ("tip", False), ("accel 1", False)])
def test_a_name_of_another_degree_of_freedom_is_asked_about(read, name, asked):
    _, said = read(uff(response=(name, 9, 2)), dof="tip")
    sentence = "fit: a.unv has the response at 3x, and the measurement is at tip. Is it the right file?"
    assert said == ([sentence] if asked else [])


def test_of_several_functions_that_of_the_measurement_is_read(read):
    others = [uff(response=("NONE", 3, 2)), uff(reference=("NONE", 7, 1))]
    text = "".join(uff([2.0 * y for y in VALUES], **more) for more in ({"response": ("NONE", 1, 1)}, {}))
    one, said = read(text + "".join(others))
    assert complex_of(one) == pytest.approx(2.0 * np.array(VALUES)) and not said
    with pytest.raises(SceneError, match=r"has 2 responses over the frequency .*; one at 3x is right"):
        read(uff() + uff())


@pytest.mark.parametrize(
    ("axes", "data", "said"),
    [
        ({"ordinate": (3, "-")}, {}, 'is of strain, and a fit is to the motion at "3x"'),
        ({"ordinate": (13, "N")}, {"quantity": "velocity"}, 'is of force, and a fit is to velocity at "3x"'),
        ({"ordinate": (12, "mm/s")}, {}, "is acceleration, in mm/s, the unit of velocity"),
        ({"ordinate": (0, "g")}, {"quantity": "velocity"}, 'is "velocity", and "a.unv" says that it is "acc'),
        ({"ordinate": (8, "rad")}, {}, 'is in rad, the unit of a rotation, and "3x" is a displacement'),
        (
            {"denominator": (12, "g")},
            {},
            "is per unit of acceleration, and the scene is driven by a [[force]]",
        ),
        ({"abscissa": (17, "s")}, {}, "its values are over the time, not over the frequency"),
    ],
)
def test_a_quantity_that_contradicts_the_scene_is_a_mistake(read, axes, data, said):
    with pytest.raises(SceneError) as caught:
        read(uff(**axes), **data)
    assert said in str(caught.value)


def test_a_response_to_a_base_is_per_unit_of_its_acceleration(read):
    base = {"direction": {"x": 1.0}, "acceleration": 3.0}
    units = {"length": "mm", "force": "N"}
    one, _ = read(uff(ordinate=(8, "mm"), denominator=(12, "m/s^2")), base=base, units=units)
    assert complex_of(one) == pytest.approx(3e-3 * np.array(VALUES))
    with pytest.raises(SceneError, match="per unit of force, and the scene is driven by the acceleration"):
        read(uff(), base=base)
    with pytest.raises(SceneError, match="per unit of displacement, and the scene has the acceleration"):
        read(uff(denominator=(8, "m")), base=base)


@pytest.mark.parametrize(
    ("axes", "factor", "told"),
    [
        ({"ordinate": (12, "g"), "denominator": (13, "N")}, 9806.65, ["is in g, converted to mm/s^2"]),
        ({"ordinate": (8, "mm"), "denominator": (13, "N")}, 1.0, []),
        ({"ordinate": (11, "in/s"), "denominator": (13, "lbf")}, 25.4 / 4.4482216152605,
         ["is in in/s, converted to mm/s", "is in lbf, converted to N"]),
        ({"ordinate": (12, "(mm/s²)/kN")}, 1e-3, ["is in kN, converted to N"]),
        ({"system": (1.0, 1.0)}, 1000.0, ["is in m, converted to mm"]),
        ({"system": (1000.0, 1000.0)}, 1000.0, ["is in units of 0.001 N, converted to N"]),
        ({"system": (1.0, 1.0), "ordinate": (8, "mm")}, 1.0, []),  # a label goes before
    ],
)  # fmt: skip
def test_another_unit_is_converted(read, axes, factor, told):
    one, said = read(uff(**axes), units={"length": "mm", "force": "N"})
    assert complex_of(one) == pytest.approx(factor * np.array(VALUES))
    assert len(said) == len(told)
    for sentence, part in zip(said, told, strict=True):
        assert sentence.startswith("fit: a.unv ") and part in sentence


def test_a_unit_is_asked_about_where_the_scene_says_none(read):
    one, said = read(uff(ordinate=(12, "g"), denominator=(13, "N")))
    assert complex_of(one) == pytest.approx(np.array(VALUES))
    assert [isinstance(sentence, Question) for sentence in said] == [True, False]
    assert said[0].startswith("fit: a.unv is in g: is the scene, too?")
    _, said = read(uff(ordinate=(12, "mV"), denominator=(13, "EU")), units={"length": "m", "force": "N"})
    assert all(isinstance(sentence, Question) for sentence in said)
    assert 'is in "mV", which is not known: taken for m/s^2' in said[0]
    assert 'is per unit of force in "EU", which is not known: taken for N' in said[1]


@pytest.mark.parametrize(
    ("axis", "size"), [((19, "rpm"), 1 / 60), ((18, "kHz"), 1e3), ((19, "NONE"), 1 / 60)]
)
def test_frequencies_in_another_unit_are_converted(read, axis, size):
    one, _ = read(uff(abscissa=axis))
    assert one.frequency == pytest.approx(2.0 * np.pi * size * HERTZ, rel=1e-6)


def test_frequencies_in_an_unknown_unit_and_an_unknown_quantity_are_asked_about(read):
    _, said = read(uff(abscissa=(18, "orders"), ordinate=(0, "NONE")))
    assert 'has frequencies in "orders", taken for Hz. Are they?' in said[0]
    assert "does not say what its values are of: are they displacements?" in said[1]


def test_drawn_points_are_in_the_unit_of_the_curves(tmp_path):
    (tmp_path / "a.unv").write_text(uff(function=12, ordinate=(12, "g"), denominator=(0, "NONE")))
    found = read_measured_points(tmp_path / "a.unv", "Hz", "mm")
    assert found.amplitude == pytest.approx(9806.65 * np.abs(VALUES) / (2.0 * np.pi * HERTZ) ** 2, rel=1e-5)


def test_responses_per_unit_of_force_need_one_force(read):
    with pytest.raises(SceneError, match=r"has responses per unit of force, which needs a scene with one"):
        read(uff(), force={"amplitude": 0.0})


def qualifier(scale=0, *, octave=0, weighting=0, window=0, normalised=0, numerator=0):
    """A dataset 1858 as pyuff's 1858.uff has it."""
    first = "".join(f"{word:12d}" for word in (0, octave, 1, 0, 0, 0))
    second = (weighting, window, scale, normalised, 0, numerator, 0, 0, 0, 0, 0, 0)
    zeros = "  0.0000000E+00" * 5
    lines = [first, "".join(f"{word:6d}" for word in second), zeros, zeros, zeros, "X+    X+", "NONE"]
    return "\n".join(["    -1", "  1858", *lines, "    -1", ""])


SPECTRUM = {"function": 12, "denominator": (0, "NONE")}


@pytest.mark.parametrize("before", [True, False])
@pytest.mark.parametrize(("scale", "factor"), [(0, 1.0), (2, 1.0), (3, np.sqrt(2.0))])
def test_amplitudes_of_a_spectrum_may_be_rms(read, scale, factor, before):
    """A sine of the amplitude 1 has the RMS value 0.707: each was fitted as 0.707."""
    parts = [qualifier(scale), uff(**SPECTRUM)]
    one, said = read("".join(parts if before else parts[::-1]))
    assert complex_of(one) == pytest.approx(factor * np.array(VALUES))
    assert len(said) == (scale != 2) and isinstance((said or [""])[0], Question) is (scale == 0)
    assert scale != 3 or said == [
        "fit: a.unv has RMS amplitudes (dataset 1858), multiplied by the square root of 2"
    ]


def test_a_spectrum_without_qualifiers_is_asked_about_and_a_ratio_is_not(read):
    _, (said,) = read(uff(**SPECTRUM))
    assert "does not say whether its amplitudes are peak values or RMS (dataset 1858): taken for peak" in said
    for text in (uff(), uff() + qualifier(3), qualifier(1) + uff()):
        one, said = read(text)
        assert complex_of(one) == pytest.approx(np.array(VALUES)) and not said


@pytest.mark.parametrize(
    ("qualifiers", "said"),
    [
        ({"scale": 1}, "has half-peak amplitudes (dataset 1858), which are not defined: export peak values"),
        ({"scale": 7}, "has amplitudes on a scale 7 (dataset 1858): export peak values (2) or RMS (3)"),
        ({"octave": 3}, "is of bands of 1/3 octave (dataset 1858): export narrow bands"),
        ({"weighting": 1}, "is weighted by frequency, A (dataset 1858): export it without weighting"),
        ({"normalised": 2}, "is in units squared per Hz (dataset 1858): export a spectrum of amplitudes"),
        ({"numerator": 2}, "is in units squared (dataset 1858): export a spectrum of amplitudes"),
    ],
)
def test_what_is_no_amplitude_of_a_narrow_band_is_refused(read, tmp_path, qualifiers, said):
    text = uff(**SPECTRUM) + qualifier(**qualifiers)
    with pytest.raises(SceneError) as caught:
        read(text)
    assert f'"a.unv" {said}' in str(caught.value)
    with pytest.raises(PlotError) as of_plot:
        read_measured_points(tmp_path / "a.unv", "Hz", "mm")
    assert said in str(of_plot.value)


def test_an_exponential_window_is_told(read):
    for window, told in ((0, False), (1, False), (4, True), (6, True)):
        _, said = read(uff() + qualifier(window=window))
        assert any("an exponential window (dataset 1858), which adds damping" in one for one in said) is told


def test_of_several_functions_each_has_the_qualifiers_beside_it(read):
    """By order where the two alternate; where all say the same by that; else it is not known."""
    other = uff([9.0 * y for y in VALUES], response=("NONE", 1, 1), **SPECTRUM)
    own, rms, peak = uff(**SPECTRUM), qualifier(3), qualifier(2)
    for text, factor in (
        (other + peak + own + rms, np.sqrt(2.0)),
        (peak + other + rms + own, np.sqrt(2.0)),
        (other + rms + own + peak, 1.0),
        (other + own + rms + rms, np.sqrt(2.0)),
        (rms + own + other, np.sqrt(2.0)),
    ):
        assert complex_of(read(text)[0]) == pytest.approx(factor * np.array(VALUES))
    for text in (other + own + rms + peak, other + rms + peak + own, rms + other + own + peak):
        with pytest.raises(
            SceneError, match="has 2 datasets 1858 that differ, and their order does not tell"
        ):
            read(text)


@pytest.mark.parametrize("damage", [("         0", "      0.x"), ("     0     0     3", "     0")])
def test_damaged_qualifiers_are_refused(read, damage):
    text = qualifier(3).replace(*damage, 1) if damage[0].endswith("0") else qualifier(3)[:120]
    text = text if text.endswith("-1\n") else text + "\n    -1\n"
    with pytest.raises(SceneError, match="a dataset 1858 begins with a line of 6 whole numbers"):
        read(uff(**SPECTRUM) + text)


def test_drawn_points_of_rms_are_amplitudes(tmp_path):
    (tmp_path / "a.unv").write_text(uff(ordinate=(8, "mm"), **SPECTRUM) + qualifier(3))
    found = read_measured_points(tmp_path / "a.unv", "Hz", "mm")
    assert found.amplitude == pytest.approx(np.sqrt(2.0) * np.abs(VALUES))
