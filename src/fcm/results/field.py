"""One variable of a response file."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy.typing as npt

from fcm.results.padded_arrays import Padded


class Field(NamedTuple):
    """One variable of the file."""

    dims: tuple[str, ...]
    values: npt.NDArray[Any] | Padded
    attrs: dict[str, str]
