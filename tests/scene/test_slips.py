"""Slips of the hand in a scene's file: the line, and what to write there; what to write is then read."""

from __future__ import annotations

import tomllib

import pytest

from fcm.scene import SceneError, load_scene
from fcm.scene.toml_mistakes import slips

SLIPS = [
    ("mu = .3", "mu = 0.3"),
    ("mu = -.3", "mu = -0.3"),
    ("factors = [np.float64(1.02), np.float64(-9.8e-01)]", "factors = [1.02, -9.8e-01]"),
    ("k_u = numpy.int64(5)", "k_u = 5"),
    ("factors = array([1.02, 0.98])", "factors = [1.02, 0.98]"),
    ("factors = np.array([1.02, 0.98], dtype=float32)", "factors = [1.02, 0.98]"),
    ("mu = 1.", "mu = 1.0"),
    ("mu = 1.e5", "mu = 1.0e5"),
    ("mu = 0,3", "mu = 0.3"),
    ("mu = 0,3 # of steel", "mu = 0.3 # of steel"),
    ("k_u = 1D5", "k_u = 1e5"),
    ("k_u = 1.5d-05", "k_u = 1.5e-05"),
    ("k_u = .5D5", "k_u = 0.5e5"),
    ("k_u = 1 000", "k_u = 1000"),
    ("k_u = 007", "k_u = 7"),
    ("normal = x", 'normal = "x"'),
    ("normal = 40x", 'normal = "40x"'),
    ("title = My first scene", 'title = "My first scene"'),
    ("dofs = [x, y]", 'dofs = ["x", "y"]'),
    ("mass = [.3, 1., 2]", "mass = [0.3, 1.0, 2]"),
    ("mass = [0,01, 0,02]", "mass = [0.01, 0.02]"),
    ("mass = [1,5; 2,5]", "mass = [1.5, 2.5]"),
    ("mass = [1 2 3]", "mass = [1, 2, 3]"),
    ('dofs = ["x" "y"]', 'dofs = ["x", "y"]'),
    ("mass = [[1, 2] [3, 4]]", "mass = [[1, 2], [3, 4]]"),
    ("mass = (1, 2)", "mass = [1, 2]"),
    ("mass = [1, 2", "mass = [1, 2]"),
    ("mass = [1, 2]]", "mass = [1, 2]]".replace("]]", "]")),
    ("normal = { x = 1, y = 2", "normal = { x = 1, y = 2 }"),
    ("normal = { x = 1 y = 2 }", "normal = { x = 1, y = 2 }"),
    ("normal = { x: 1 }", "normal = { x = 1 }"),
    ("pairs = True", "pairs = true"),
    ("pairs = no", "pairs = false"),
    ('title = "one', 'title = "one"'),
    ('title = one"', 'title = "one"'),
    ("title = “one”", 'title = "one"'),
    ('title = "one”', 'title = "one"'),
    ("title = 'it's'", 'title = "it\'s"'),
    ("mu = −0.3", "mu = -0.3"),
    ("mu 0.3", "mu = 0.3"),
    ("mu: 0.3", "mu = 0.3"),
    ("mu == 0.3", "mu = 0.3"),
    ("mu = 0.3;", "mu = 0.3"),
    ("mu = 0.3,", "mu = 0.3"),
    ("mu = 0.3 k_u = 2", "mu = 0.3 and k_u = 2"),
    ("mu = 30 %", "mu = 0.3"),
    ("mu = { normal = [0.3, 20 %] }", "mu = { normal = [0.3, 0.06] }"),
    ("mu = { normal = [30 %, 20 %] }", "mu = { normal = [0.3, 0.06] }"),
    ("n_0 = { normal = [-5, 10%], count = 3 }", "n_0 = { normal = [-5, 0.5], count = 3 }"),
    ("frequency = [10 Hz, 20 Hz]", "frequency = [10, 20]"),
    ("phase = 45deg", 'phase = "45deg"'),
    ("[modal", "[modal]"),
    ("[[contact]", "[[contact]]"),
    ("[contact]]", "[[contact]]"),
    ("contact.*.n_0 = [1]", '"contact.*.n_0" = [1]'),
    ("// steel", "# steel"),
    (r'file = "C:\data\K.mtx"', r"file = 'C:\data\K.mtx'"),
    ("k_u = 3 e5", "k_u = 3e5"),
    ("k_u = 3e 5", "k_u = 3e5"),
    ("k_u = 1e5.0", "k_u = 1e5"),
    ("mu = 00.3", "mu = 0.3"),
    ("k_u = 1,000,000.5", "k_u = 1000000.5"),
    ("k_u = 1,000,000", "k_u = 1000000"),
    ("k_u = 1,000.5", "k_u = 1000.5"),
    ("mu = 1/4", "mu = 0.25"),
    ("k_u = 10^5", "k_u = 100000.0"),
    ("k_u = [2*10, 2**3]", "k_u = [20.0, 8.0]"),
    ("phase = pi/2", "phase = 1.5707963267948966"),
    ("mu = infinity", "mu = inf"),
    ("modal]", "[modal]"),
    ("title\u00a0= 'x'", "title = 'x'"),
]


@pytest.mark.parametrize("wrong, right", SLIPS)
def test_the_line_and_what_to_write(wrong, right):
    (said,) = slips(f"before = 1\n{wrong}\nafter = '.3'\n")
    assert said.startswith("line 2, ") and said.endswith(f": write {right}")
    tomllib.loads("\n".join(["before = 1", *right.split(" and "), "after = '.3'"]))
    assert not slips(right.replace(" and ", "\n"))


def test_all_slips_of_a_file_are_said_at_once(tmp_path):
    text = "title = x\n[modal]\ndofs = [u]\nfrequency = [.5, 1.]\n[[contact]\nmu = 0,3\n[modal]\nmass = 1\n"
    (tmp_path / "s.toml").write_text(text)
    with pytest.raises(SceneError) as caught:
        load_scene(tmp_path / "s.toml")
    assert [one.partition(",")[0] for one in caught.value.mistakes] == [
        f"line {n}" for n in (1, 3, 4, 5, 6, 7)
    ]
    assert "write frequency = [0.5, 1.0]" in caught.value.mistakes[2]


@pytest.mark.parametrize(
    "text, words",
    [
        ("a = 1\nb = 2\na = 3\n", "line 3, a = 3: the key a is there twice: it is in line 1 already"),
        ("[modal]\na = 1\n[modal]\n", "line 3, [modal]: the table is there twice: it is in line 1 already"),
        ("[contact]\na = 1\n[contact]\n", "it is in line 1 already: write [[contact]] each time"),
        ("[force]\na = 1\n[[force]]\n", "it is in line 1 already: write [[force]] each time"),
        ("normal = { w.x = 1, w = 2 }\n", "put a name with a dot in quotes"),
        ("mu = 0x1G\n", 'line 1, mu = 0x1G: 0x1G begins with 0x as a number to the base 16, and "G"'),
        ("mu = [0b12]\n", 'to the base 2, and "2" is no digit of it'),
        ("mu = 0X1F\n", "it begins with 0x, 0o or 0b, in small letters: write mu = 0x1F"),
        ("mass = [\n1,\n2\n", "line 3, 2: a bracket is missing at its end: write 2]"),
        ("k_u = 1.0e\n", "line 1, k_u = 1.0e: something follows a value"),
        ("mu =\n", "line 1, mu =: there is no value behind ="),
        ("mu = None\n", "line 1, mu = None: there is no value behind ="),
        ('a = """x\n', "at its end: a string has no quotes at its end"),
        ("mass = [" + "1, " * 100 + ".5]\n", "line 1, .5]: a number begins with a digit: write 0.5]"),
        ("m = [[1, 2],\n  [3, 4]\nb = 3\n", "line 2, [3, 4]: a bracket is missing at its end: write [3, 4]]"),
        ("a = 1\rb = 2\r", "each key is on a line of its own"),
        ("=\n" * 3000, "line 1, ="),
    ],
)  # fmt: skip
def test_what_a_line_alone_does_not_tell(text, words):
    said = slips(text)
    assert len(said) == 1 and words in said[0]


def test_text_that_is_not_utf_8_names_its_line(tmp_path):
    (tmp_path / "s.toml").write_bytes("a = 1\nb = 'ü'\n".encode("latin-1"))
    with pytest.raises(SceneError, match="save it as UTF-8; the first letter that is none is in line 2"):
        load_scene(tmp_path / "s.toml")
    (tmp_path / "s.toml").write_bytes("a = 1\n".encode("utf-16"))
    with pytest.raises(SceneError, match=r"save it as UTF-8$"):
        load_scene(tmp_path / "s.toml")


@pytest.mark.parametrize("word, written", [("True", "true"), ("FALSE", "false"), ("Inf", "inf")])
def test_a_word_of_another_language_is_not_told_to_need_quotes(tmp_path, word, written):
    path = tmp_path / "a.toml"
    path.write_text(f"[structure]\nflexibility = {word}\n")
    with pytest.raises(SceneError) as refused:
        load_scene(path)
    said = str(refused.value)
    assert f"write flexibility = {written}" in said and "quotes" not in said
