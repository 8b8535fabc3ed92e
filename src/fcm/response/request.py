"""Requests for a curve, with given harmonics or an accuracy that chooses them, and their error class."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np

from fcm.frozen import Frozen
from fcm.harmonic_balance.system import System
from fcm.model.scene import Scene
from fcm.response.options import INPUT_LIMITS, RESPONSE, ResponseOptions
from fcm.scene.rules import harmonics_fault, harmonics_up_to
from fcm.table import Table


class ResponseError(ValueError):
    """The calculation cannot begin; the message says why."""


class Request(Frozen):
    """Request for a curve: with given harmonics, or with as many as an accuracy needs.

    With one harmonic and a table, points are solutions with the closed form, and the errors of the table are
    reported. If corrected is false, points are the solutions with the table.
    """

    harmonics: tuple[int, ...] | None = (1,)
    accuracy: float = INPUT_LIMITS.accuracy
    table: Table | None = None
    corrected: bool = True
    options: ResponseOptions = RESPONSE

    def system(self, scene: Scene, harmonics: tuple[int, ...] | None = None) -> System:
        """The system of a scene (of one curve) without a table, optionally with other harmonics."""
        chosen, options = harmonics or self.harmonics or (1,), self.options
        return System(scene, chosen, options=options.balance, other_options=options.others)


ONE_HARMONIC = Request()


def request_of(
    scene: Scene,
    harmonics: int | Sequence[int] | None,
    accuracy: float | None,
    options: ResponseOptions | None = None,
) -> Request:
    """The request of a caller, else of the scene, else the default accuracy.

    Raises
    ------
    ResponseError
        If both are given, or they are out of range.
    """
    if harmonics is not None and accuracy is not None:
        raise ResponseError("harmonics and accuracy exclude one another: the second chooses the first")
    if harmonics is None and accuracy is None:
        harmonics, accuracy = scene.harmonics, scene.accuracy
    if harmonics is None:
        accuracy = INPUT_LIMITS.accuracy if accuracy is None else accuracy
        if not isinstance(accuracy, Real) or not 0.0 < accuracy < 1.0:
            value = f"{accuracy:g}" if isinstance(accuracy, Real) else repr(accuracy)
            raise ResponseError(f"accuracy is {value}, but it is a relative error between 0 and 1")
        return Request(None, accuracy, options=options or RESPONSE)
    chosen = _numbers(harmonics)
    if fault := harmonics_fault(chosen):
        raise ResponseError(f"harmonics must be {fault}")
    return Request(chosen, options=options or RESPONSE)


def _numbers(harmonics: object) -> tuple[Any, ...]:
    """Harmonics up to a number, or the given ones; numpy integers are accepted."""
    if isinstance(harmonics, Integral) and not isinstance(harmonics, bool):
        return harmonics_up_to(int(harmonics))
    some = harmonics if isinstance(harmonics, Iterable) else (harmonics,)
    return tuple(int(h) if isinstance(h, np.integer) else h for h in some)
