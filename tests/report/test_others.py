"""Other packages beside fcm: ratios, errors, folds and who is ahead, of made-up measurements."""

import json

import pytest

from . import others, published, recorded


def made(name, peak, seconds, state="", folds=2, points=100):
    return {"name": name, "peak": peak, "seconds": seconds, "state": state, "folds": folds, "points": points}


@pytest.fixture
def folder(tmp_path):
    """Two preloads and two random scenes, of which fcm leaves one; and one package, which stops once."""
    asked = [
        ("a", "preloads", 2.0, 2, made("", 2.0, 0.1)),
        ("b", "preloads", 4.0, 0, made("", 4.0, 0.3)),
        ("r0", "random", 1.0, None, made("", 1.0, 0.1)),
        ("r1", "random", 1.0, None, made("", 1.0, 9.0, "stuck")),
    ]
    names = ("name", "group", "peak", "folds", "fcm")
    problems = [{**dict(zip(names, one, strict=True)), "harmonics": 1} for one in asked]
    results = [
        {**made("a", 2.02, 1.0), "harmonics": 1, "samples": 64},
        {**made("b", 4.0, 1.0, folds=0), "harmonics": 1, "samples": 64},
        {**made("a", 2.002, 3.0), "harmonics": 1, "samples": 128},
        {**made("b", 3.0, 9.0, "stopped after 9 s"), "harmonics": 1, "samples": 128},
        {**made("r0", 1.5, 1.0), "harmonics": 1, "samples": 256},
        {**made("r1", 1.0, 1.0), "harmonics": 1, "samples": 256},
    ]
    (tmp_path / "problems.json").write_text(json.dumps({"versions": "fcm 0", "problems": problems}))
    text = {"versions": "pyHarm-os 1.2", "limit": 9.0, "results": results}
    (tmp_path / "pyharm.json").write_text(json.dumps(text))
    return tmp_path


def test_rows_count_what_is_finished(folder):
    own, coarse, fine = others.rows(*others.read(folder))
    assert own.package == "fcm" and own.seconds == pytest.approx(0.4) and own.ratio == 1.0
    assert coarse.finished == 2 and coarse.ratio == pytest.approx(2.0 / 0.4) and coarse.folds_right == 2
    assert coarse.errors == pytest.approx([0.01, 0.0])
    assert fine.finished == 1 and fine.ratio == pytest.approx(3.0 / 0.1)  # of the same curve alone


def test_who_is_ahead_is_said(folder):
    problems, found = others.read(folder)
    assert others.ahead(problems, found) == ["pyHarm-os completes r1, and fcm does not"]
    problems["problems"][0]["fcm"]["seconds"] = 7.7
    assert "128 samples takes 0.39 times the time of fcm" in " ".join(others.ahead(problems, found))
    (said,) = others.at_equal_error(problems, found)
    assert "1.0e-03 with 128 samples" in said and "below it" in said and "NOT" not in said


def test_random_scenes_and_what_was_not_measured(folder):
    shown = others.section(folder)
    assert [row[:3] for row in shown.tables[1].rows] == [
        ("fcm", "1 of 2", "-"),
        ("pyHarm-os", "2 of 2", "1"),
    ]
    assert "tmdsimpy: not measured" in shown.text and "pyHarm-os 1.2" in " ".join(shown.text)
    others.draw(folder, folder / "others.png")
    assert (folder / "others.png").stat().st_size > 10_000


def test_published_numbers_that_differ_are_failures(tmp_path):
    rows = [["one", "peak", "1", "1", True], ["other", "peak", "2", "3", False]]
    (tmp_path / "published.json").write_text(json.dumps(rows))
    assert published.failures(tmp_path / "published.json") == [("other", "peak: 3, published 2")]
    assert "1 of 2 agree." in published.section(tmp_path / "published.json").text


def test_what_was_not_run_is_said(tmp_path):
    assert "make study makes it" in recorded.section(recorded.STUDY, tmp_path, tmp_path).text[-1]
