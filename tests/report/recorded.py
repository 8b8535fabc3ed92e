"""What a target of ``make`` has printed, and drawn, as a section of the page."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import NamedTuple

from .page import Section

MISSING = "not in this report: {0} makes it, and make report then takes it"


class Recorded(NamedTuple):
    """A target, the file of what it printed, and what that is."""

    title: str
    target: str
    file: str
    about: str
    picture: str = ""
    caption: str = ""


CONVERGENCE = Recorded(
    "With more and more harmonics", "make convergence", "convergence.txt",
    "Greatest error of the peaks against the exact motion, and processor time in ms where np.sin takes 10 ns "
    "a value, with harmonics 1 to H; by the table alone, before its points are corrected; and the time of "
    "the exact motion. The order is p of error ~ H^-p from H = 2 on.",
    "convergence.png", "Error of the peaks against processor time with 1 to 15 harmonics, of five scenes.",
)  # fmt: skip
STUDY = Recorded(
    "Random scenes", "make study", "study.txt",
    "Two hundred scenes of one to four contacts and two to twelve modes, stiffness ratios from 1e-3 to 1e6: "
    "how many are complete with three step limits and agree, and how true peaks and errors are with the "
    "accuracy 1e-2. Alone: no exact motion is beside the peak. Unknown: no error is estimated. 2x: "
    "estimates within a factor of two; low3, high3: those off by more than three. Last, what exact curves of "
    "24 scenes of seven modes and more take that hardly anything damps.",
)  # fmt: skip
CALIBRATION = Recorded(
    "Estimated over true errors", "make calibration", "calibration.txt",
    "Hard curves with 1, 2, 3 and 5 harmonics: how many estimates are within a factor of two of the truth, "
    "which is the exact motion or the balance of 21 harmonics, and how many are off by more than three.",
)  # fmt: skip
KEPT_MODES = Recorded(
    "Modes that are left out", "make kept-modes", "kept-modes.txt",
    "A blade of 600 degrees of freedom with a contact at a corner of its tip, at preloads at which it sticks "
    "or slips, or is all but open. Greatest relative errors of its peaks, against those of 300 modes; bounds "
    "are those that the run states, of a resonance's damping and of receptances.",
    "kept-modes.png", "With the flexibility of the modes that are not kept a few modes are enough; without "
    "it the compliance of the blade beside its contact comes in with the inverse of their number.",
)  # fmt: skip


def section(one: Recorded, results: Path, folder: Path) -> Section:
    """With what is recorded in the folder of results, or with how to make it."""
    file = results / one.file
    if not file.is_file():
        return Section(one.title, text=(one.about, f"This is {MISSING.format(one.target)}."))
    picture = results / one.picture
    shown = bool(one.picture) and picture.is_file()
    if shown:
        shutil.copyfile(picture, folder / one.picture)
    return Section(
        one.title, text=(one.about,), picture=one.picture if shown else "", width=140.0, caption=one.caption,
        commands=(one.target,), printed=file.read_text(encoding="utf-8").rstrip(),
    )  # fmt: skip
