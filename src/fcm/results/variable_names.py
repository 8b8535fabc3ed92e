"""Names of a file's variables for keys of a scene, whose contacts may be called anything."""

from __future__ import annotations

import re
from collections.abc import Iterable

_KEPT = re.compile(r"[A-Za-z][A-Za-z0-9_.+@-]*")  # netCDF's own rule, before it took other signs as well
_OTHER = re.compile(r"[^A-Za-z0-9_.+@-]")


def variable_names(keys: Iterable[str]) -> dict[str, str]:
    """A name for each key, all different, that netCDF, CF and a list of names parted by blanks can hold.

    A key that is such a name stays as it is. Else each other sign becomes an underscore, and a number ends
    what would be there twice; the key itself belongs in an attribute then. A letter begins every name.

    >>> variable_names(["contact.left shroud.n_0", "contact.left_shroud.n_0", "1/x"])
    {'contact.left shroud.n_0': 'contact.left_shroud.n_0_2', 'contact.left_shroud.n_0': \
'contact.left_shroud.n_0', '1/x': 'n_1_x'}
    """
    keys = list(keys)
    taken = {key for key in keys if _KEPT.fullmatch(key)}
    names = {}
    for key in keys:
        if key not in taken:
            name = first = _begun_with_letter(_OTHER.sub("_", key))
            number = 1
            while name in taken:
                number += 1
                name = f"{first}_{number}"
            taken.add(name)
            names[key] = name
    return {key: names.get(key, key) for key in keys}


def _begun_with_letter(name: str) -> str:
    return name if name[:1].isalpha() else f"n_{name}"
