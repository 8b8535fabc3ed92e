"""One bar for a whole run: parts of it, none of which ever goes back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from fcm.run.work import Progress

ALMOST = 0.999  # of a batch that is not known to be finished


class Bar:
    """How much of each batch is finished, shown as the progress of all."""

    def __init__(self, sizes: Sequence[int], finished: Iterable[int], progress: Progress | None) -> None:
        self.sizes, self.done, self.progress = sizes, [0.0] * len(sizes), progress
        for number in finished:
            self.done[number] = 1.0

    def of(self, number: int, draw: bool) -> Progress:
        """The progress of one batch; draw if it comes from the thread that may draw."""

        def show(fraction: float, _text: str) -> None:
            self.done[number] = max(self.done[number], ALMOST * min(fraction, 1.0))
            if draw:
                self.draw()

        return show

    def finish(self, number: int) -> None:
        """A batch is finished."""
        self.done[number] = 1.0
        self.draw()

    def draw(self) -> None:
        """Show it."""
        if self.progress is not None:
            total = sum(self.sizes)
            done = sum(size * share for size, share in zip(self.sizes, self.done, strict=True))
            self.progress(done / total, f"{int(done)} of {total} curves")


def part(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """The progress of one of several calculations, as a part of all."""
    if progress is None:
        return None
    return lambda fraction, text: progress(begin + (end - begin) * fraction, text)
