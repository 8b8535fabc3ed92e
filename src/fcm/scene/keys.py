"""All keys of a scene: what each means, its allowed values, and its default.

Readers of tables refuse a key that is not here; `fcm respond --keys` prints all keys.
"""

from __future__ import annotations

from fcm.frozen import Frozen
from fcm.scene.rules import FRACTION, POSITIVE, RULES, Rule

REQUIRED = "required"


class Key(Frozen):
    """Description of one key of a table."""

    meaning: str
    value: str | Rule  # allowed values
    default: str = REQUIRED  # value if it is not given

    @property
    def kind(self) -> str:
        """What values the key may have, in words."""
        return self.value if isinstance(self.value, str) else _in_words(self.value)


def _in_words(rule: Rule) -> str:
    return f"number {rule.text}".replace("number a ", "")


def _rule(key: str, more: str) -> str:
    """The values that a number may have, in words, and whether several may be given."""
    return f"{_in_words(RULES[key])}{more}"


_DIRECTION = "a degree of freedom, or a table of weights"
_WITH_NODES = '; with nodes x, y, z, a table of these, or "fitted"'
_MATRIX = "a file, or a list of rows"
_FILES = "; files are .npz, .mat, .h5, .mtx, .op4, .sti, .mas, .pch, .matrix and .hb"
_EACH_MODE = "; one for all modes, or a list"
_OF_PAIRS = "; of pairs also a list, a text file, or a column of their file"
_GIVEN = "file"

TABLES: dict[str, dict[str, Key]] = {
    "": {
        "title": Key("of the scene, for pictures and files", "string", "empty"),
        "frequency_unit": Key("of all frequencies, also in results", '"rad/s" or "Hz"', '"rad/s"'),
        "modal": Key("the structure by its modes, without the contacts", "[modal]", "[structure]"),
        "structure": Key("the structure by its matrices, without the contacts", "[structure]", "[modal]"),
        "cyclic": Key("the structure is a sector of a ring, around which a wave travels", "[cyclic]", "none"),
        "contact": Key("the contacts", "[[contact]]", "none"),
        "force": Key("the harmonic forces", "[[force]]", "needed without [base]"),
        "load": Key("static loads", "[[load]]", "none"),
        "base": Key("harmonic motion of the base; displacements are relative to it", "[base]", "at rest"),
        "units": Key("for labels and files; only universal files and measured data are converted",
                     "[units]", "none"),
        "response": Key("what is traced", "[response]", "needed without [[schedule]]"),
        "sweep": Key("numbers of the scene that are varied, a curve for each value", "[sweep]", "one curve"),
        "optimum": Key("numbers that are chosen so that a peak is least", "[optimum]", "nothing is chosen"),
        "fit": Key("numbers that are fitted to measured data", "[fit]", "nothing is fitted"),
        "schedule": Key("phases of a simulation in time", "[[schedule]]", "none"),
        "start": Key("the state that the schedule starts from, and friction of contacts that never slip",
                     "[start]", "rest"),
    },
    "modal": {
        "file": Key("of modes; keys beside it go before its own", ".npz, .mat, .uff or .unv", "none"),
        "dofs": Key("names of the degrees of freedom", "list of names", _GIVEN),
        "mass": Key("modal masses phi^T M phi; given if a universal file has 0 for them",
                    _rule("mass", _EACH_MODE), "1: shapes are mass-normalised"),
        "frequency": Key("undamped natural frequencies; 0 for rigid-body modes",
                         _rule("frequency", "; a list, one for each mode"), _GIVEN),
        "damping": Key("damping ratios: 0.01 is 1 % of critical damping", _rule("damping", _EACH_MODE),
                       _GIVEN),
        "shapes": Key("shapes[i][j]: mode i at dofs[j]", "list of lists", _GIVEN),
        "participation": Key("phi^T M d, d the direction of [base]", _rule("participation", _EACH_MODE),
                             "none"),
        "nodal_diameter": Key("of each mode, with [cyclic]; shapes may have pairs [re, im]",
                              _rule("nodal_diameter", _EACH_MODE), "none"),
        "pairs": Key("whether modes are pairs c, s of the whole ring. Where c is this sector's, the next "
                     "has c cos a - s sin a, a = 2 pi nodal_diameter / sectors",
                     "true or false", "false, of different frequencies"),
    },
    "structure": {
        "dofs": Key("names of the rows", "list of names, or a text file", "file"),
        "file": Key("of the names of the rows, one on each line", "text file", "dofs"),
        "mass": Key("mass matrix; a list of numbers is its diagonal", _MATRIX),
        "stiffness": Key(f"stiffness matrix{_FILES}", _MATRIX),
        "damping": Key("ratio of every mode, 0.01 is 1 % of critical damping; in proportion; or a matrix",
                       "ratio, table, or matrix as above"),
        "modes": Key(
            "how many are kept", "whole number", "all up to 3 times the highest frequency, at least 10"
        ),
        "flexibility": Key("whether that of the other modes is kept", "true or false", "true"),
        "coupling": Key("to the next sector, with [cyclic]", "table", "none"),
    },
    "structure.coupling": {
        "mass": Key("block of this sector's rows and the next one's columns", _MATRIX, "none"),
        "stiffness": Key("block of this sector's rows and the next one's columns", _MATRIX, "none"),
    },
    "structure.damping": {
        "mass": Key("factor of the mass matrix; a mode has the ratio mass / (2 omega), omega in rad/s",
                    RULES["damping"], "0"),
        "stiffness": Key("factor of the stiffness matrix; a mode has the ratio stiffness * omega / 2",
                         RULES["damping"], "0"),
        "loss_factor": Key("hysteretic damping, twice the ratio in resonance", RULES["damping"], "none"),
    },
    "cyclic": {
        "sectors": Key("how many there are", RULES["sectors"]),
        "engine_order": Key("of the forces: that on sector k is 2 pi k engine_order / sectors ahead",
                            RULES["engine_order"]),
        "mistuning": Key("blades that differ: the whole ring is computed", "[cyclic.mistuning]",
                         "none: one sector"),
    },
    "cyclic.mistuning": {
        "factors": Key("of the blades' stiffness, one for each sector, or drawn for count rings",
                       "list, or draws as in [sweep]"),
        "of": Key("what the factors are of; a frequency's is squared", '"stiffness" or "frequency"',
                  '"stiffness"'),
        "scale": Key("factors are 1 + scale * (factor - 1); can be swept", RULES["scale"], "1"),
        "blade": Key("with [structure]: degrees of freedom of the blade, without its root",
                     'list of names, or of patterns such as "40*"', "stiffness"),
        "stiffness": Key("of the blade, in the degrees of freedom of the sector", _MATRIX,
                         "blade; with [modal] that of a family of modes"),
    },
    "contact": {
        "name": Key("of the contact", "string"),
        "tangential": Key("the displacement u along which it slides. In a plane a list of two"
                          f"{_WITH_NODES}", _DIRECTION, "required, but with mu = 0"),
        "nodes": Key("pairs [[a, b], ...], a .csv file, or two sets; u and v are of a less b",
                     "list, file or table", "none: one contact"),
        "areas": Key("of the pairs: one k_u, k_v or n_0 is a total. That of a list, file or column is of "
                     "each pair, and a swept one is the total of the pairs",
                     'list of numbers > 0, or "equal"', "the numbers are of each pair"),
        "normal": Key(f"the displacement v that loads it: n = max(n_0 + k_v v, 0){_WITH_NODES}", _DIRECTION),
        "mu": Key(f"friction coefficient{_OF_PAIRS}", RULES["mu"]),
        "k_u": Key(f"tangential contact stiffness{_OF_PAIRS}", RULES["k_u"], "required with tangential"),
        "k_v": Key(f"normal contact stiffness{_OF_PAIRS}", RULES["k_v"]),
        "n_0": Key(f"preload that presses the faces, negative a gap{_OF_PAIRS}",
                   RULES["n_0"], "gap"),
        "gap": Key("distance of the faces at rest, instead of a preload. Positive is apart: "
                   f"n_0 = -k_v * gap{_OF_PAIRS}", RULES["gap"], "n_0"),
    },
    "contact.nodes": {
        "sets": Key("of two sides, or one that touches the ground: sets of the mesh, or files of nodes",
                    'list such as ["LEFT", "RIGHT"]', "pairs"),
        "pairs": Key("of nodes; the mesh shows how far they are apart", ".csv file", "sets"),
        "mesh": Key("where the nodes are", ".inp, .bdf, .msh, or .csv with node,x,y,z"),
        "tolerance": Key("how far partners may be apart", POSITIVE, "of one set, and of a file, none"),
    },
    "force": {
        "dof": Key("where it acts", _DIRECTION),
        "amplitude": Key("of amplitude * sin(omega t + phase), positive along dof", RULES["amplitude"]),
        "phase": Key("in rad, or in degrees; a positive one is ahead", 'a number, or as "45deg"', "0"),
        "harmonic": Key("of amplitude * sin(harmonic * omega t + phase)", "whole number from 1", "1"),
        "proportional_to": Key("amplitude times omega^2, omega in rad/s", '"omega^2"', "constant"),
    },
    "load": {
        "dof": Key("where it acts", _DIRECTION, "file"),
        "file": Key("of its distribution, a number for each row", ".npz, .mat or .mtx file", "dof"),
        "force": Key("its amount, positive along dof; of a file, a factor", RULES["force"], "1 with a file"),
    },
    "base": {
        "acceleration": Key("of acceleration * sin(omega t + phase), positive along direction",
                            RULES["acceleration"]),
        "direction": Key("of its motion; modes have participation instead", "x, y, z or a table of weights"),
        "phase": Key("in rad, or in degrees", 'a number, or as "45deg"', "0"),
    },
    "units": {
        "length": Key("of displacements", "string", "none"),
        "force": Key("of forces", "string", "none"),
    },
    "response": {
        "frequency": Key("[from, to], the range that is traced", POSITIVE, "needed without [[schedule]]"),
        "max_step": Key("longest step, relative to the curve's own extent", FRACTION, "0.05"),
        "harmonics": Key("harmonics that are balanced: up to a number, or some of them",
                         "1 to 50, or a list such as [1, 2, 3, 9]", "as many as accuracy takes"),
        "accuracy": Key("relative error of greatest peaks and folds; it chooses harmonics", FRACTION, "0.01"),
        "output": Key("degrees of freedom to show, and to be accurate; netCDF has those of contacts, too",
                      "list of names, or of patterns such as \"40*\"", "all if they are 50 at most"),
    },
    "optimum": {
        "vary": Key("one to three numbers of the scene by their paths, or \"level\", of all forces",
                    'list such as ["contact.NAME.n_0"]'),
        "bounds": Key("of each number", "[[from, to], ...]", "its sweep; or 0 to 10 times what it is"),
        "minimise": Key("of which the greatest is to be least; greatest.NAME counts the range's ends",
                        '"peak.NAME", or a list of such'),
    },
    "fit": {
        "vary": Key("numbers of the scene by their paths",
                    'list such as ["contact.*.mu", "modal.damping.0"]'),
        "bounds": Key("of each number", "[[from, to], ...]", "a hundredth to a hundred times what it is"),
        "starts": Key("tried at most, the scene's numbers first", "whole number, 1 to 100", "8"),
        "data": Key("what was measured", "[[fit.data]]"),
    },
    "fit.data": {
        "file": Key("of a response: frequency, amplitude, and any of phase, weight and levels",
                    ".csv, .mat, .npz, .uff or .unv", "backbone"),
        "backbone": Key("of a nonlinear mode: amplitude, frequency, damping ratio, and weight",
                        ".csv, .mat or .npz", "file"),
        "dof": Key("that was measured", "a degree of freedom", "of a backbone: its amplitude is modal"),
        "level": Key("of the scene's forces; a column has the force of each point", "number, or column", "1"),
        "quantity": Key("that was measured", '"displacement", "velocity" or "acceleration"',
                        '"displacement"'),
        "mode": Key("of the backbone, counted from 1", "whole number", "1"),
        "amplitude_error": Key("relative to the greatest amplitude", FRACTION, "estimated"),
        "frequency_error": Key("relative", FRACTION, "1e-6; of a backbone estimated"),
        "damping_error": Key("relative to the greatest damping ratio", FRACTION, "estimated"),
    },
    "schedule": {
        "frequency": Key("of the forces in this phase", POSITIVE),
        "cycles": Key("periods of the forces in this phase", POSITIVE),
    },
    "start": {
        "displacement": Key("modal, one number for each mode", "list of numbers", "zeros"),
        "velocity": Key("modal, one number for each mode", "list of numbers", "zeros"),
        "friction": Key("friction forces of the contacts with the structure undisplaced; of one that never "
                        "slips also on curves. A pair for one in a plane",
                        "list of numbers and pairs", "zeros"),
        "angle": Key("of the forces, omega t", RULES["phase"], "0"),
    },
    "sweep": {
        "paired": Key("keys that go in step, with as many values each", "[[sweep.paired]]", "none"),
        "correlation": Key("of keys that are drawn", "[sweep.correlation]", "none: they are independent"),
        '"contact.NAME.n_0"': Key("a number of the scene by its path, in quotes",
                                  "list, range or draws", "none"),
    },
    "sweep.correlation": {
        "keys": Key("drawn keys, equally often", "list of key paths"),
        "matrix": Key("of their normal scores (a Gaussian copula)", "list of rows"),
    },
}  # fmt: skip

OMEGA = "rad/s or Hz"  # depends on frequency_unit
STIFFNESS = "force / length"
MASS = "force s^2 / length"
UNITS = {  # units of numbers by path; "1" for dimensionless ones
    "modal.mass": MASS,
    "modal.frequency": OMEGA,
    "modal.damping": "1",
    "modal.shapes": "1; with mass-normalised ones mass^(-1/2)",
    "modal.participation": "mass times that of shapes",
    "modal.nodal_diameter": "1",
    "structure.mass": MASS,
    "structure.stiffness": STIFFNESS,
    "structure.damping": "1; of a matrix force s / length",
    "structure.modes": "1",
    "structure.coupling.mass": MASS,
    "structure.coupling.stiffness": STIFFNESS,
    "structure.damping.mass": "1/s",
    "structure.damping.stiffness": "s",
    "structure.damping.loss_factor": "1",
    "cyclic.sectors": "1",
    "cyclic.engine_order": "1",
    "cyclic.mistuning.factors": "1",
    "cyclic.mistuning.scale": "1",
    "cyclic.mistuning.stiffness": STIFFNESS,
    "contact.areas": "length^2",
    "contact.mu": "1",
    "contact.k_u": STIFFNESS,
    "contact.k_v": STIFFNESS,
    "contact.n_0": "force",
    "contact.gap": "length",
    "contact.nodes.tolerance": "length of the mesh",
    "force.amplitude": "force; in proportion to omega^2 mass times length",
    "force.phase": "rad or deg",
    "force.harmonic": "1",
    "load.force": "force",
    "base.acceleration": "length / s^2",
    "base.phase": "rad or deg",
    "response.frequency": OMEGA,
    "response.max_step": "1",
    "response.harmonics": "1",
    "response.accuracy": "1",
    "optimum.bounds": "that of the number",
    "fit.bounds": "that of the number",
    "fit.starts": "1",
    "fit.data.level": "1; of a column force",
    "fit.data.mode": "1",
    "fit.data.amplitude_error": "1",
    "fit.data.frequency_error": "1",
    "fit.data.damping_error": "1",
    "schedule.frequency": OMEGA,
    "schedule.cycles": "1",
    "start.displacement": "of modal coordinates",
    "start.velocity": "of modal coordinates, per s",
    "start.friction": "force",
    "start.angle": "rad",
    'sweep."contact.NAME.n_0"': "that of the number; phases rad",
    "sweep.correlation.matrix": "1",
}

LISTS = (
    "contact",
    "force",
    "load",
    "schedule",
    "sweep.paired",
    "fit.data",
)  # tables that are written [[...]]


def names(table: str) -> tuple[str, ...]:
    """Names of the keys of a table.

    >>> names("schedule")
    ('frequency', 'cycles')
    """
    return tuple(TABLES[table])


def unit_of(table: str, name: str) -> str:
    """The unit of a number of a table; empty for keys that are not numbers.

    >>> unit_of("contact", "k_u"), unit_of("contact", "name")
    ('force / length', '')
    """
    return UNITS.get(".".join(filter(None, (table, name))), "")


def as_lines() -> list[tuple[str, str, str, str]]:
    """All keys as (path, allowed values, default, meaning).

    >>> as_lines()[0]
    ('title', 'string', 'empty', 'of the scene, for pictures and files')
    """
    return [
        (
            ".".join(filter(None, (_written(table), name))),
            _with_unit(key.kind, unit_of(table, name)),
            key.default,
            key.meaning,
        )
        for table, keys in TABLES.items()
        for name, key in keys.items()
    ]


def _with_unit(kind: str, unit: str) -> str:
    return kind if unit in ("", "1") else f"{kind} [{unit}]"


def _written(table: str) -> str:
    return f"{table}[]" if table in LISTS else table
