"""All curves of a scene by whatever computes them: in batches, on cores, kept while they are not written."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field

from fcm.response.curve_batches import KINDS, Group, anonymous, as_curve, fit
from fcm.results.result import NOT_BEGUN, Curve
from fcm.run import Checkpoint, Compute, Factory, Lost, Progress, Results, fingerprint, place_for, sweep


@dataclass
class CurveSweep:
    """Where curves are computed and kept: the same for everything that one run computes."""

    jobs: int  # processes of this machine
    checkpoint: Checkpoint | None
    place: Factory | None = None  # instead: an executor or a cluster
    defects: list[str] = field(default_factory=list)  # tracebacks, of curves that were lost to them

    def curves(
        self,
        compute: Compute,
        batches: Sequence[Group],
        mark: bytes,
        progress: Progress | None,
        states: tuple[type, ...] = (),
    ) -> list[Curve]:
        """The curves of all batches in order; those that could not be had say why.

        mark : digest of everything besides the scenes that decides the results.
        states : what compute saves consists of these.
        """
        kept = Results()
        if self.checkpoint is not None:
            whole = fingerprint(mark, [anonymous(batch) for batch in batches])
            kept = self.checkpoint.results(whole, (*KINDS, *states), lambda i, found: fit(batches, i, found))
        place = self.place or place_for(self.jobs if len(batches) > 1 else 1)
        outcome = sweep(compute, batches, place, kept, progress)
        if outcome.lost:
            warnings.warn(outcome.lost, stacklevel=2)
        curves: list[Curve] = []
        for number, batch in enumerate(batches):
            found = outcome.of(number)
            found += [None] * (len(batch) - len(found))
            curves += [as_curve(scene, one, NOT_BEGUN) for scene, one in zip(batch, found, strict=True)]
            self.defects += [one.defect for one in found if isinstance(one, Lost) and one.defect]
        return curves
