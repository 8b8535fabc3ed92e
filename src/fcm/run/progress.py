"""Progress of a whole run, as the sum of parts that never decrease."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from fcm.run.options import RUN
from fcm.run.tasks import Progress


class Bar:
    """Finished share of each batch, shown as the progress of all."""

    def __init__(self, sizes: Sequence[int], finished: Iterable[int], progress: Progress | None) -> None:
        self.sizes, self.shares, self.progress = sizes, [0.0] * len(sizes), progress
        self.total, self.text = sum(sizes), ""
        for number in finished:
            self._set(number, 1.0)

    def of(self, number: int, draw: bool) -> Progress:
        """The progress function of one batch; `draw` if the calling thread may draw."""

        def show(fraction: float, text: str) -> None:
            self._set(number, RUN.almost_done * min(fraction, 1.0))
            if draw:
                self.text = text
                self.draw()

        return show

    def finish(self, number: int) -> None:
        """Marks a batch as finished."""
        self._set(number, 1.0)
        self.text = ""
        self.draw()

    def draw(self) -> None:
        """Shows the progress."""
        if self.progress is not None:
            done = [size * share for size, share in zip(self.sizes, self.shares, strict=True)]
            text = f"{sum(map(int, done))} of {self.total} curves"
            self.progress(sum(done) / self.total, f"{text}: {self.text}" if self.text else text)

    def _set(self, number: int, share: float) -> None:
        self.shares[number] = max(share, self.shares[number])


def part(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """The progress function of one of several calculations, from `begin` to `end` of all."""
    if progress is None:
        return None
    return lambda fraction, text: progress(begin + (end - begin) * fraction, text)
