"""Converts the damping of a [structure] table to modal damping ratios, with notes on what these omit."""

from __future__ import annotations

import numpy as np

from fcm.frozen import Frozen
from fcm.model.scene import FloatArray
from fcm.scene.options import MESSAGES
from fcm.scene.structure_table import StructureMatrices
from fcm.structure.damping import (
    DampedModes,
    check_dissipates,
    coupling_effect,
    drag,
    projected,
    proportional,
    ratios,
)
from fcm.structure.reduced import Reduced

_AT_ONE = "{ stiffness = LOSS_FACTOR / OMEGA } has it right at one frequency OMEGA in rad/s"


class Damping(Frozen):
    """Damping ratios (mode,), and notes on the damping that they omit.

    lost bounds the relative error of a receptance from omitting the damping of rigid-body modes. The error is
    relative to the receptance at rest, or to that of the rigid-body modes at the same frequency.
    """

    ratio: FloatArray
    lost: float
    said: list[str]


def damping_of(
    matrices: StructureMatrices,
    found: Reduced,
    loads: FloatArray,
    springs: FloatArray,
    outputs: list[int],
    ends: tuple[float, float],
) -> Damping:
    """Damping of the modes; the arguments are those of `reduction.modal_of_matrices`."""
    stiffness, rigid = found.modes.stiffness, found.rigid
    if matrices.ratio is not None:
        return Damping(np.full(stiffness.size, matrices.ratio), 0.0, _of_floating(matrices.ratio, rigid))
    if matrices.hysteretic:
        half = matrices.hysteretic / 2.0
        equal = (
            "structure: half the loss factor is taken as damping ratio, which is equal at each resonance "
            "without contacts. Where contacts move a resonance far, or hold rigid bodies, it is another."
            f"{_while_stuck(half, stiffness, found.modes.shapes.conj().T @ loads, springs)} {_AT_ONE}"
        )
        return Damping(np.full(stiffness.size, half), 0.0, [equal])
    if matrices.C is None:
        ratio = proportional(matrices.by_mass, matrices.by_stiffness, stiffness)
        modal = np.diag(matrices.by_mass + matrices.by_stiffness * stiffness)
        dragged = matrices.by_mass if rigid else 0.0
    else:
        modal = projected(matrices.C, found.modes)
        check_dissipates(np.diagonal(modal).real)
        ratio = ratios(np.diagonal(modal).real, stiffness)
        dragged = drag(matrices.C, found.modes.shapes[:, :rigid])
    said = _left_out(dragged, [])
    if np.isfinite(ends).all() and (dragged or matrices.C is not None):
        left = found.modes.shapes.conj().T
        pushes = left @ loads
        seen = np.hstack((pushes, left[:, outputs]))
        modes = DampedModes(stiffness, modal, rigid)
        effects = [coupling_effect(modes, pushes, seen, k, ends) for k in (0.0 * springs, springs)]
        if max(effects) <= MESSAGES.damping_left_out:  # as for a body without excitation
            dragged = 0.0
        said = _left_out(dragged, effects)
    lowest = ends[0] if np.isfinite(ends[0]) else 0.0
    return Damping(ratio, float(dragged / np.hypot(lowest, dragged)) if dragged else 0.0, said)


def _while_stuck(half: float, stiffness: FloatArray, pushes: FloatArray, springs: FloatArray) -> str:
    """Sentence comparing the damping ratio of the first stuck resonance with hysteretic damping; or ''.

    A stuck mode x (mode,) of frequency omega has the ratio half sum_i omega_i |x_i|^2 / omega. With
    hysteretic damping it would have half sum_i omega_i^2 |x_i|^2 / omega^2.
    """
    squares, shapes = np.linalg.eigh(np.diag(stiffness) + (pushes * springs) @ pushes.conj().T)
    first = int((squares > stiffness.max(initial=0.0) * np.finfo(np.float64).eps * squares.size).argmax())
    if not squares.size or not squares[first] > 0.0:
        return ""
    share, omega = np.abs(shapes[:, first]) ** 2, np.sqrt(squares[first])
    taken = half * float(np.sqrt(np.maximum(stiffness, 0.0)) @ share) / omega
    meant = half * float(stiffness @ share) / omega**2
    if abs(taken - meant) <= MESSAGES.damping_left_out * meant:
        return ""
    return f" With all of them stuck the first has {taken:.3g} in place of {meant:.3g}."


def _of_floating(ratio: float, rigid: int) -> list[str]:
    """Note on the meaning of a common damping ratio if contacts hold rigid-body modes."""
    if not ratio or not rigid:
        return []
    return [
        "structure: its damping ratio is of modes without contacts, and rigid-body modes have none. Where "
        f"contacts hold these, a resonance has less: see its ratio while stuck. {_AT_ONE}, with "
        "LOSS_FACTOR twice the ratio"
    ]


def _left_out(dragged: float, effects: list[float]) -> list[str]:
    """Notes on omitted damping, with its effects on the linear response if known."""
    if not dragged and max(effects, default=0.0) <= MESSAGES.damping_left_out:
        return []
    what = "damping between modes is left out"
    if dragged:
        what = "the damping of its rigid-body modes is left out: a mode of frequency 0 has no ratio"
    if not effects:
        return [f"structure: {what}"]
    free, stuck = map(_share, effects)
    high = ": a resonance that is damped mostly by what is left out is far too high"
    return [
        f"structure: {what}; with it, the response within the range would change by {free} without contacts, "
        f"{stuck} with all of them stuck{high if max(effects) >= 1.0 else ''}"
    ]


def _share(change: float) -> str:
    """A relative change in words; above 1, as at a resonance left without damping, it gets no number.

    >>> _share(0.00123), _share(0.996), _share(2.0)
    ('up to about 0.12 %', 'up to about 100 %', 'more than itself')
    """
    percent = 100.0 * change
    if percent >= 100.0:
        return "more than itself"
    return f"up to about {percent:.0f} %" if percent >= 10.0 else f"up to about {percent:.2g} %"
