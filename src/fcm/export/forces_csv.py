"""Contact forces at peaks and chosen frequencies as CSV, for stress recovery."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from fcm.results.motions import LINE, PLANE, ResponseMotion
from fcm.results.result import Response
from fcm.units import headed, in_unit


def write_forces(motions: Sequence[ResponseMotion], response: Response, path: Path) -> None:
    """Write a row for each motion, contact, direction and harmonic; harmonic 0 is the mean.

    Columns: curve, swept values, peak of (or the mode), frequency, contact, force (friction or
    normal), harmonic, amplitude and phase [rad] of amplitude * sin(harmonic omega t + phase), and its
    real and imaginary part.
    """
    unit, force = response.frequency_unit, response.units[1]
    swept = motions[0].parameters if motions else {}
    heads = [headed(key, *response.units, unit) for key in swept]
    of_force = f" [{force}]" if force else ""
    columns = ["curve", *heads, "peak of", f"frequency [{unit}]", "contact", "force", "harmonic"]
    columns += [f"amplitude{of_force}", "phase [rad]", f"real{of_force}", f"imag{of_force}"]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        for motion in motions:
            writer.writerows(_rows(motion, response))


def _rows(motion: ResponseMotion, response: Response) -> Iterator[list[object]]:
    of = f"mode at {motion.amplitude:g}" if np.isfinite(motion.amplitude) else " ".join(motion.of)
    begin = [motion.curve, *motion.parameters.values(), of]
    begin += [repr(float(in_unit(motion.frequency, response.frequency_unit)))]
    kinds = LINE if motion.force.shape[1] == len(LINE) else PLANE
    for contact, of_contact in zip(response.contacts, motion.force, strict=True):
        for kind, values in zip(kinds, of_contact, strict=True):
            if kind == PLANE[1] and contact not in response.directions:  # of a contact on a line
                continue
            for harmonic, value in zip((0, *motion.harmonics), values.tolist(), strict=True):
                size = value.real if harmonic == 0 else abs(value)
                phase = 0.0 if harmonic == 0 else float(np.angle(value))
                numbers = map(repr, (size, phase, value.real, value.imag))
                yield [*begin, contact, kind, harmonic, *numbers]
