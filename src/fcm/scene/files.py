"""Files that a scene refers to: where they are, and how large they may be."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import field
from errno import EACCES, EIO
from pathlib import Path

from fcm.files import no_file
from fcm.frozen import Frozen
from fcm.model.interface import Interface
from fcm.scene.errors import quoted
from fcm.scene.options import FILES, MESSAGES


class DataFileError(ValueError):
    """Raised for a file of modes, matrices or names that cannot be read, with a sentence for each reason."""

    def __init__(self, *faults: str) -> None:
        self.faults = faults
        super().__init__("; ".join(faults))


class UnreadableError(ValueError):
    """Raised for a file that cannot be read; the message is for users, and lacks the name of the file."""


def reason_of(error: Exception, ending: str) -> str:
    """Why a file cannot be read, in words for users: errors of libraries are replaced by a general reason.

    >>> reason_of(UnreadableError("it is cut off"), ".npz"), reason_of(ValueError("zip() argument"), ".npz")
    ('it is cut off', 'it is damaged, or no .npz file')
    """
    if isinstance(error, UnreadableError | DataFileError):
        return str(error)
    if isinstance(error, MemoryError):
        return "there is not enough memory for it"
    if isinstance(error, OSError) and error.errno in (EACCES, EIO):
        return error.strerror or "it cannot be opened"
    return f"it is damaged, or no {ending} file"


class Files(Frozen):
    """The files that a scene refers to, and what was noted while they were read."""

    folder: Path = Path()
    largest: int = FILES.largest  # bytes, unpacked
    read: list[Path] = field(default_factory=list, compare=False)  # those that were opened
    said: list[str] = field(default_factory=list, compare=False)  # sentences on the matrices
    masses: dict[str, float] = field(default_factory=dict, compare=False)  # of the structure, by axis
    meshes: list[bool] = field(default_factory=list, compare=False)  # see `structure_table.is_mesh`
    noted: list[str] = field(default_factory=list, compare=False)  # notes on node pairs and measured data
    interfaces: list[Interface] = field(default_factory=list, compare=False)  # contacts with node places

    @contextmanager
    def opened(self, name: str) -> Iterator[Path]:
        """The path of a file that exists and is not too large; any error within becomes a DataFileError."""
        path = self.folder / name
        self.read.append(path)
        try:
            if what := no_file(path):
                backslash = not name.isprintable()
                within = (
                    ", and has a special character: write \\ twice, or the name in '...'" if backslash else ""
                )
                raise DataFileError(f"{_shown(path)} {what}{within}")
            self.check_size(path, path.stat().st_size)
            yield path
        except DataFileError:
            raise
        except Exception as error:  # a damaged file can cause any error in its reader
            reason = reason_of(error, path.suffix)
            raise DataFileError(f"{_shown(path)} cannot be read: {reason[:500]}") from None

    def check_size(self, path: Path, size: int) -> None:
        """Refuse a file whose unpacked size is too large."""
        if size > self.largest:
            raise DataFileError(
                f"{_shown(path)} holds {megabytes(size)}; at most {megabytes(self.largest)} are read: "
                "raise the limit by --largest-file (in Python, largest_file)"
            )


def megabytes(size: int) -> str:
    """A number of bytes in MB, the unit of the option.

    >>> megabytes(3_000_000_000)
    '3000 MB'
    """
    return f"{size / 1e6:.4g} MB" if size < 1e9 else f"{size / 1e6:.0f} MB"


def _shown(path: Path) -> str:
    return quoted(str(path), MESSAGES.longest_path)
