"""The tables of a comparison, from made-up summaries."""

from typing import ClassVar

import numpy as np

from fcm.compare.comparison import Comparison
from fcm.compare.errors import Reference
from fcm.compare.lines import Line, line_of
from fcm.compare.methods import CLOSED_FORM, EXACT
from fcm.compare.output import peaks as of_peaks
from fcm.compare.tables import costs, marked, peaks
from fcm.results.peak import Peak
from fcm.scene import load_scene


def test_a_method_stands_once_where_there_is_nothing_to_leave_out():
    run = {
        "method": "closed form", "max_step": 0.05, "corrected": True, "points": 9, "seconds": 0.1,
        "processor_seconds": 0.1, "start_seconds": None, "table_seconds": None, "evaluations": 20,
    }  # fmt: skip
    runs = [{**run, "left_out": True}, {**run, "left_out": False, "evaluations": 30}]

    def rows(left_out):
        return [
            (row[1], row[-1]) for row in costs({"runs": runs, "max_step": 0.05, "left_out": left_out})[1:]
        ]

    assert rows([]) == [("nothing", "20")]
    assert rows(["contact shroud: held"]) == [("yes", "20"), ("no", "30")]


def test_no_peak_is_without_the_word_that_it_is_unstable():
    """The exact peak of u is unstable, the balance's is not told; those of v are stable."""
    scene, w = load_scene("yang1998-n5"), np.array([1.0, 1.1, 1.2])
    tops = {"u": (2.0, 1.1), "v": (1.0, 1.1)}
    amplitude = np.array([[1.0, 0.5], [2.0, 1.0], [1.0, 0.5]])

    def line(u):
        return Line(w, amplitude, tops, (), True, stable={"u": u, "v": 1.0})

    comparison = Comparison(scene)
    for name, stable in ((EXACT, 0.0), (CLOSED_FORM, np.nan)):
        comparison.references[name] = Reference(name, 0.1, [line(stable)])
    found = of_peaks(comparison)
    assert [(one["exact"]["stable"], one["harmonic"]["stable"]) for one in found] == [
        (False, None),
        (True, True),
    ]
    shown = {"peaks": found, "frequency_unit": "rad/s"}
    assert [row[1] for row in peaks(shown)[1:]] == ["2.00000!", "1.00000"]
    assert [row[3] for row in peaks(shown)[1:]] == ["2.00000?", "1.00000"]
    assert [text[0] for text in marked(shown)] == ["!", "?"]
    assert line_of(Known, scene).stable == {"u": 0.0, "v": 1.0}


class Known:
    """What a line takes of a curve."""

    frequency, amplitude, folds = np.array([1.0]), np.array([[2.0, 1.0]]), []
    complete, reason, evaluations = True, "", 3
    peaks: ClassVar = {"u": Peak(2.0, 1.0, 0.1, 0.0), "v": Peak(1.0, 1.0, 0.1, 1.0)}
