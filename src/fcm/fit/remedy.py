r"""Whether one change of all measured points repairs a poor misfit: a factor, phases turned or reversed.

The change is g y or g conj(y) of the measured complex amplitudes y. Its inverse h = 1/g fits the computed
amplitudes c best: the sum of w |h c - y|^2 is least for h = sum w conj(c) y / sum w |c|^2. If the phase is
kept, h is the real part of this; if the size is kept, only its argument. The responses are computed with the
fitted numbers and with those of the scene, since a fit to wrong units can end where no factor helps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from fcm.fit.forced import NoMotionError, errors_of, forced_rows, measured_points
from fcm.fit.options import FIT, FitOptions
from fcm.fit.parameters import Parameters
from fcm.fit.solve import Solved
from fcm.frozen import Frozen
from fcm.model.scene import FloatArray, Measured, Scene

ComplexArray = npt.NDArray[np.complex128]


class Change(Frozen):
    """A change of measured points: a factor on amplitudes; phases reversed if opposite, then turned."""

    factor: float = 1.0
    turn: float = 0.0  # [rad]
    opposite: bool = False

    def of(self, data: Measured) -> Measured:
        """The data with this change."""
        phase = data.phase
        if phase is not None:
            phase = (-phase if self.opposite else phase) + self.turn
        return replace(data, amplitude=self.factor * data.amplitude, phase=phase, estimated=None)

    def __str__(self) -> str:
        """The change in words.

        >>> str(Change(0.001)), str(Change(turn=-1.5708, opposite=True))
        ('a factor of 0.001 on the amplitudes', 'phases of the opposite sign, turned by -90 degrees')
        """
        parts = [f"a factor of {self.factor:.2g} on the amplitudes"] if self.factor != 1.0 else []
        turned = f"turned by {np.degrees(self.turn):.0f} degrees" if self.turn else ""
        if self.opposite:
            parts.append(f"phases of the opposite sign{f', {turned}' if turned else ''}")
        elif turned:
            parts.append(f"phases {turned}")
        return " and ".join(parts)

    @property
    def question(self) -> str:
        """A question about what may be wrong with the data."""
        asked = ["are unit and quantity right"] if self.factor != 1.0 else []
        if self.opposite or self.turn:
            asked.append("are phases those of sin(omega t + phase), as of the scene's forces")
        return f"{', and '.join(asked)}?"


class _Beside(Frozen):
    """Measured points and the nearest computed ones, as complex amplitudes, with their weights."""

    measured: ComplexArray
    computed: ComplexArray
    weight: FloatArray
    phased: bool

    def best(self, scaled: bool, turned: bool, opposite: bool) -> tuple[float, Change] | None:
        """The best change of a kind, after its mean square misfit; None if there is none."""
        y = self.measured.conj() if opposite else self.measured
        product = complex((self.weight * self.computed.conj() * y).sum())
        size = float((self.weight * np.abs(self.computed) ** 2).sum())
        if not size > 0.0:
            return None
        h = product / size if turned else complex(product.real / size)
        if not scaled:
            h = h / abs(h) if turned and h else 1.0 + 0.0j
        if not abs(h) > 0.0 or (not turned and h.real < 0.0):
            return None
        off = float((self.weight * np.abs(h * self.computed - y) ** 2).sum())
        change = Change(1.0 / abs(h) if scaled else 1.0, float(-np.angle(h)) if turned else 0.0, opposite)
        return off, change


def remedy(
    parameters: Parameters, found: Solved, harmonics: tuple[int, ...], options: FitOptions = FIT
) -> str:
    """Sentence on a change of the data that reduces a poor misfit below `remedied`; empty if none does.

    The change applies to all responses, or to one file alone.
    """
    data, off = [], []
    for one, rows in zip(found.data, found.parts, strict=True):
        if one.damping is None:
            data.append(one)
            unit = errors_of(one, False, options).amplitude / one.amplitude.max()
            off.append(float(np.sqrt(((rows.residual**2).sum(axis=1) * unit**2).mean())))
    poor = [i for i, own in enumerate(off) if own > options.poor_misfit]
    groups = [list(range(len(data)))] if poor else []
    groups += [[i] for i in poor] if len(data) > 1 else []
    for group in groups:
        before = float(np.sqrt(np.mean([off[i] ** 2 for i in group])))
        members = [data[i] for i in group]
        if told := _of_group(parameters, found.values, members, before, harmonics, options):
            return f"{'all files' if len(group) > 1 else members[0].file}: {told}"
    return ""


def _of_group(
    parameters: Parameters,
    values: FloatArray,
    group: Sequence[Measured],
    before: float,
    harmonics: tuple[int, ...],
    options: FitOptions,
) -> str:
    """Sentence on the simplest of the most effective changes of some data; before is their misfit."""
    limit, told = options.remedied * before, list[tuple[int, float, str]]()
    for numbers, whose in ((values, ""), (parameters.start, " with the numbers of the scene")):
        scene = parameters.at(numbers)
        beside = _beside(scene, group, harmonics, replace(options, amplitude_error=options.scale_error))
        for parts, change in _changes(beside, limit) if beside is not None else ():
            after = _beside(scene, [change.of(one) for one in group], harmonics, options)
            if after is not None and (off := _misfit(after)) < limit:
                ends = f"from {100.0 * before:.2g} % to {100.0 * off:.2g} %"
                told.append((parts, off, f"{change} would bring the misfit {ends}{whose}: {change.question}"))
    near = min((off for _, off, _ in told), default=0.0) / options.remedied
    return min((one for one in told if one[1] <= near), default=(0, 0.0, ""))[2]


def _changes(beside: _Beside, limit: float) -> list[tuple[int, Change]]:
    """Changes with a misfit below a limit, each after the number of its parts."""
    flags = (False, True) if beside.phased else (False,)
    kinds = [(scaled, turned, other) for scaled in (False, True) for turned in flags for other in flags]
    found = [(sum(kind), best) for kind in kinds if any(kind) and (best := beside.best(*kind)) is not None]
    return [(parts, change) for parts, (off, change) in found if off < limit**2]


def _misfit(beside: _Beside) -> float:
    return float(np.sqrt((beside.weight * np.abs(beside.computed - beside.measured) ** 2).sum()))


def _beside(
    scene: Scene, group: Sequence[Measured], harmonics: tuple[int, ...], options: FitOptions
) -> _Beside | None:
    """Measured points with the model's nearest points; None where the model has no response."""
    parts = []
    for one in group:
        plain = replace(one, estimated=None, amplitude_error=None)
        errors = errors_of(plain, False, options)
        try:
            rows = forced_rows(scene, (), harmonics, plain, errors, options)
        except (NoMotionError, np.linalg.LinAlgError):
            return None
        y = measured_points(plain)[:, 1:]
        c = y + rows.residual[:, 1:] * errors.amplitude[:, None]
        weight = np.full(one.points, 1.0 / (len(group) * one.points * one.amplitude.max() ** 2))
        parts.append((_complex(y), _complex(c), weight))
    measured, computed, weights = (np.concatenate(one) for one in zip(*parts, strict=True))
    return _Beside(measured, computed, weights, all(one.phase is not None for one in group))


def _complex(parts: FloatArray) -> ComplexArray:
    """Amplitudes (point, 1), or real and imaginary parts (point, 2), as complex numbers."""
    found: ComplexArray = parts @ np.array([1.0, 1.0j])[: parts.shape[1]]
    return found
