"""Two measured joints of others: what of them the friction of a few contacts can tell, and what not.

usage: python -m tests.studies.measured FOLDER [OUT]

FOLDER has the data, which are not in this repository:
`brb_forced.mat`, forced responses of the Brake-Reuss beam near 80 Hz, at four levels of the force and eight
of the response (github.com/mattiacenedese/BRBtesting; Chen and others, MSSP 166 (2022) 108401);
`asb_c1_matrices.mat` and `asb_c1_backbone.mat`, a bolted beam reduced to four patches of its joint, and its
measured backbone (github.com/Nidish96/Computational-Work-For-ASB-Project).

Scenes, data as read by [fit], results and pictures are written into OUT, build/measured. A run that was
interrupted goes on.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import numpy.typing as npt
import scipy.io
import scipy.linalg

from fcm.fit.forced import errors_of, forced_rows
from fcm.fit.options import FIT
from fcm.plot.style import house_style, new_figure
from fcm.response.fit import fit
from fcm.results.fitted import Fitted
from fcm.run import Execution
from fcm.scene.load import load_scene

from ..guide.figures import BLUE, ORANGE

FloatArray = npt.NDArray[np.float64]
FORCE, RESPONSE = "ForceControl", "ResponseControl"
SLIDERS = ((2000.0, 0.12), (2000.0, 0.24), (2000.0, 0.4))  # guesses: stiffness [N/m], slip load [N]
SEATED = (
    1e9  # N/m: of each patch across the joint, and by its area of its tilting; far stiffer than the beams
)
FASTEST = 1e5  # Hz: modes above are of the patches' own flexibility
BINS = 24  # of the backbone's 3746 points


def listed(values: Any) -> str:
    return json.dumps(np.asarray(values).tolist())


def written(path: Path, columns: dict[str, FloatArray]) -> str:
    """A CSV file of columns; its name."""
    rows = "\n".join(
        ",".join(f"{value:.12g}" for value in row) for row in zip(*columns.values(), strict=True)
    )
    path.write_text(f"{','.join(columns)}\n{rows}\n", encoding="utf-8")
    return path.name


def fitted(path: Path) -> Fitted:
    """The fit of a scene; what is finished of it is kept beside it until it is done."""
    told = sys.stderr.isatty()

    def show(fraction: float, text: str) -> None:
        if told:
            print(f"\r{path.stem}: {100.0 * fraction:3.0f} % {text:60s}", end="", file=sys.stderr)

    keep = path.with_suffix(".unfinished")
    response = fit(load_scene(path), execution=Execution(keep=keep, resume=keep.exists(), progress=show))
    assert response.fitted is not None
    return response.fitted


def print_numbers(title: str, found: Fitted) -> None:
    print(f"\n{title}")
    for key, value, error in zip(found.keys, found.values, found.error, strict=True):
        print(f"  {key:24s} {value:12.6g} +- {error:.2g}")
    for doubt in found.problems():
        print(f"  {doubt}")


def beam_levels(folder: Path, kind: str) -> list[dict[str, FloatArray]]:
    """Columns of each level of the Brake-Reuss beam."""
    data = scipy.io.loadmat(folder / "brb_forced.mat", squeeze_me=True, struct_as_record=False)["FRdata"]
    return [
        {
            key: np.asarray(getattr(one, key), dtype=float)
            for key in ("frequency", "amplitude", "phase", "force")
        }
        for one in getattr(data, kind)
    ]


def beam_scene(folder: Path, out: Path) -> Path:
    """One mode and parallel sliders; the accelerometer looks against the force."""
    text = 'frequency_unit = "Hz"\n[modal]\ndofs = ["u", "a"]\nmass = [2.0]\nfrequency = [79.95]\n'
    text += "damping = [0.0014]\nshapes = [[1.0, -1.0]]\n"
    for k, (stiffness, load) in enumerate(SLIDERS, 1):
        text += f'[[contact]]\nname = "s{k}"\ntangential = "u"\nnormal = "u"\nmu = 1.0\nk_u = {stiffness}\n'
        text += f"k_v = 0.0\nn_0 = {load}\n"
    text += '[[force]]\ndof = "u"\namplitude = 1.0\n[response]\nfrequency = [79.0, 81.5]\nharmonics = 1\n'
    keys = ["modal.mass.0", "modal.frequency.0", "modal.damping.0"]
    keys += [f"contact.s{k}.{part}" for k in range(1, len(SLIDERS) + 1) for part in ("k_u", "n_0")]
    text += f"[fit]\nvary = {json.dumps(keys)}\nstarts = 1\n"
    for k, level in enumerate(beam_levels(folder, FORCE)):
        name = written(out / f"force{k}.csv", level)
        text += f'[[fit.data]]\nfile = "{name}"\ndof = "a"\nlevel = "force"\nquantity = "acceleration"\n'
    path = out / "beam.toml"
    path.write_text(text, encoding="utf-8")
    return path


def beam_tried(folder: Path, out: Path, fitted_scene: Path, found: Fitted) -> list[tuple[FloatArray, ...]]:
    """Frequencies [Hz], measured and modelled accelerations of the eight levels of the response."""
    text = fitted_scene.read_text(encoding="utf-8").split("[[fit.data]]")[0]
    for k, level in enumerate(beam_levels(folder, RESPONSE)):
        name = written(out / f"response{k}.csv", level)
        text += f'[[fit.data]]\nfile = "{name}"\ndof = "a"\nlevel = "force"\nquantity = "acceleration"\n'
    path = out / "tried.toml"
    path.write_text(text, encoding="utf-8")
    scene = load_scene(path)
    assert scene.fit is not None
    from fcm.fit.parameters import parameters_of

    there = parameters_of(scene, found.keys, [None] * len(found.keys)).at(found.values)
    rows = []
    for one in scene.fit.data:
        errors = errors_of(one, False, FIT)
        residual = forced_rows(there, found.keys[:1], (1,), one, errors, FIT).residual
        rows.append(_compared(one, residual * errors.amplitude[:, None]))
    return rows


def _compared(one: Any, off: FloatArray) -> tuple[FloatArray, ...]:
    """Frequency [Hz], measured amplitude, and that of the model: of complex values, model less measured."""
    value = one.amplitude * np.exp(1j * one.phase)
    return one.frequency / (2.0 * np.pi), one.amplitude, np.abs(value + off[:, 1] + 1j * off[:, 2])


def misfit(measured: FloatArray, model: FloatArray) -> float:
    """Root mean square, relative to the greatest."""
    return float(np.sqrt(((model - measured) ** 2).mean()) / measured.max())


def draw_beam(path: Path, parts: list[list[tuple[FloatArray, ...]]]) -> None:
    with house_style():
        mpl.rcParams.update({"font.size": 8})
        figure = new_figure(6.2, 2.8)
        for axes, rows, title in zip(
            figure.subplots(1, 2), parts, ("fitted: four forces", "tried: eight responses"), strict=True
        ):
            for k, (frequency, measured, model) in enumerate(rows):
                axes.plot(frequency, measured, "+", color=BLUE, ms=3, label=None if k else "measured")
                axes.plot(frequency, model, "-", color=ORANGE, lw=0.8, label=None if k else "model")
            axes.set(xlabel="frequency [Hz]", ylabel="acceleration [m/s²]", title=title)
            axes.legend(fontsize=7)
        figure.savefig(path, dpi=110)


def linear_equivalent(level: dict[str, FloatArray]) -> tuple[float, float]:
    """Frequency [Hz] and damping ratio of the linear oscillator nearest to a level.

    Of its force over acceleration, -m (w0^2 - w^2 + 2 i zeta w0 w) / w^2, by least squares.
    """
    omega = 2.0 * np.pi * level["frequency"]
    dynamic = omega**2 * level["force"] / (level["amplitude"] * np.exp(1j * level["phase"]))
    design = np.column_stack((np.ones_like(omega), -(omega**2)))
    (stiffness, mass), *_ = np.linalg.lstsq(design, dynamic.real, rcond=None)
    natural = float(np.sqrt(stiffness / mass))
    return natural / (2.0 * np.pi), float((dynamic.imag / omega).mean() / (2.0 * mass * natural))


def beam(folder: Path, out: Path) -> None:
    """The Brake-Reuss beam."""
    for kind in (FORCE, RESPONSE):
        for k, level in enumerate(beam_levels(folder, kind), 1):
            frequency, damping = linear_equivalent(level)
            print(
                f"  {kind} {k}, {level['amplitude'].max():.1f} m/s^2 at most: as a linear oscillator "
                f"{frequency:.2f} Hz, damping {100.0 * damping:.2f} %"
            )
    path = beam_scene(folder, out)
    found = fitted(path)
    print_numbers("Brake-Reuss beam, one mode and three parallel sliders", found)
    fitted_rows = [_compared(one.measured, one.residual * one.error) for one in found.data]
    tried = beam_tried(folder, out, path, found)
    for name, rows in (("force", fitted_rows), ("response", tried)):
        for k, (frequency, measured, model) in enumerate(rows, 1):
            peaks = [float(frequency[one.argmax()]) for one in (measured, model)]
            print(
                f"  {name} level {k}: misfit {100.0 * misfit(measured, model):.1f} %, greatest "
                f"{measured.max():.1f} m/s^2, model {model.max():.1f}, at {peaks[0]:.2f} Hz, {peaks[1]:.2f}"
            )
    draw_beam(out / "brake-reuss.png", [fitted_rows, tried])


def joint_scene(folder: Path, out: Path) -> Path:
    """Modes with open patches, which do not part or tilt, and four contacts in the plane of the joint."""
    data = scipy.io.loadmat(folder / "asb_c1_matrices.mat", squeeze_me=True)
    M, K, relative, patches = data["M"], data["K"], data["L"][:24], range(4)
    springs = np.zeros(24)
    for p in patches:
        springs[6 * p + 2] = SEATED
        springs[6 * p + 3 : 6 * p + 5] = SEATED * data["PatchAreas"][p] / 12.0
    K = K + relative.T @ (springs[:, None] * relative)
    square, modes = scipy.linalg.eigh(0.5 * (K + K.T), M)
    frequency = np.sqrt(np.abs(square)) / (2.0 * np.pi)
    kept = frequency < FASTEST
    rows = np.array([relative[6 * p + c] for p in patches for c in range(3)])
    dofs = [f"p{p + 1}{c}" for p in patches for c in "xyz"]
    text = (
        f'frequency_unit = "Hz"\n[modal]\ndofs = {json.dumps(dofs)}\nfrequency = {listed(frequency[kept])}\n'
    )
    text += f"damping = {listed(np.full(kept.sum(), 6e-4))}\nshapes = {listed((rows @ modes[:, kept]).T)}\n"
    guesses = (("weak1", 4e4, 0.15), ("weak2", 8e4, 0.9), ("held1", 3.6e6, 1e3), ("held2", 3.6e6, 1e3))
    for p, (name, stiffness, load) in enumerate(guesses, 1):
        text += f'[[contact]]\nname = "{name}"\ntangential = ["p{p}x", "p{p}y"]\nnormal = "p{p}z"\nmu = 1.0\n'
        text += f"k_u = {stiffness}\nk_v = 0.0\nn_0 = {load}\n"
    text += '[[force]]\ndof = "p1x"\namplitude = 1.0\n[response]\nfrequency = [80.0, 100.0]\nharmonics = 1\n'
    keys = ["contact.held*.k_u", "modal.damping"]
    keys += [f"contact.weak{k}.{part}" for k in (1, 2) for part in ("k_u", "n_0")]
    backbone = scipy.io.loadmat(folder / "asb_c1_backbone.mat", squeeze_me=True)
    bins = np.array_split(np.argsort(backbone["Q"]), BINS)
    columns = {
        "amplitude": np.array([np.exp(np.log(backbone["Q"][one]).mean()) for one in bins]),
        "frequency": np.array([backbone["W"][one].mean() for one in bins]),
        "damping": np.array([backbone["Z"][one].mean() for one in bins]),
    }
    text += f"[fit]\nvary = {json.dumps(keys)}\nstarts = 1\n"
    text += f'[[fit.data]]\nbackbone = "{written(out / "backbone.csv", columns)}"\nmode = 2\n'
    path = out / "joint.toml"
    path.write_text(text, encoding="utf-8")
    return path


def joint(folder: Path, out: Path) -> None:
    """The bolted beam."""
    found = fitted(joint_scene(folder, out))
    print_numbers("bolted beam, four patches in the plane of the joint", found)
    (part,) = found.data
    one, off = part.measured, part.residual * part.error
    assert one.damping is not None
    hertz = one.frequency / (2.0 * np.pi), (one.frequency + off[:, 0]) / (2.0 * np.pi)
    damping = one.damping, one.damping + off[:, 1]
    for name, (measured, model) in (("frequency [Hz]", hertz), ("damping ratio", damping)):
        print(
            f"  {name}: {measured[0]:.6g} to {measured[-1]:.6g}, model {model[0]:.6g} to {model[-1]:.6g}, "
            f"misfit {100.0 * misfit(measured, model):.2g} %"
        )
    with house_style():
        mpl.rcParams.update({"font.size": 8})
        figure = new_figure(6.2, 2.6)
        for axes, name, (measured, model) in zip(
            figure.subplots(1, 2), ("frequency [Hz]", "damping ratio"), (hertz, damping), strict=True
        ):
            axes.plot(one.amplitude, measured, "+", color=BLUE, label="measured")
            axes.plot(one.amplitude, model, "-", color=ORANGE, label="fitted")
            axes.set(xscale="log", xlabel="modal amplitude", ylabel=name)
        axes.legend()
        figure.savefig(out / "bolted-beam.png", dpi=110)


def main(folder: str, out: str = "build/measured") -> None:
    where = Path(out)
    where.mkdir(parents=True, exist_ok=True)
    joint(Path(folder), where)
    beam(Path(folder), where)


if __name__ == "__main__":
    main(*sys.argv[1:])
