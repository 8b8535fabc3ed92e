"""Reads the [cyclic] table: the scene then describes one sector of a ring of equal sectors."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from fcm.model.question import Question
from fcm.model.ring import NEXT, Ring
from fcm.model.scene import Modal, Scene
from fcm.scene.errors import Mistakes, quoted
from fcm.scene.keys import names
from fcm.scene.mistuning import read_mistuning
from fcm.scene.names import Names
from fcm.scene.options import TOLERANCES
from fcm.scene.rules import RULES
from fcm.scene.section import Part, Section

WHOLE_RING = "needs the whole ring: write all its sectors out as a scene without [cyclic]"
TABLES = {  # tables that have no meaning for one sector, and why
    "schedule": f"a simulation in time {WHOLE_RING}",
    "start": f"a simulation in time {WHOLE_RING}",
}
SHAKES = "a base that moves shakes all sectors alike, along the axis; give [[force]]"


class RingNames(Names):
    """The names of a sector's degrees of freedom, followed by those of the next sector."""

    @cached_property
    def own(self) -> Names:
        """Names of the sector itself, without those of the next sector."""
        own = Names(name for name in self if not name.startswith(NEXT))
        own.key = self.key
        return own

    def find(self, name: str) -> str:
        """Finds a name as `Names.find` does, also one of the next sector such as "next.40x".

        >>> RingNames(("40x", "tip", "next.40x", "next.tip")).find("next.40:1")
        'next.40x'
        """
        if not name.startswith(NEXT):
            return self.own.find(name)
        found = self.own.find(name.removeprefix(NEXT))
        return f"{NEXT}{found}" if found else ""


def own_name(name: str) -> str:
    """The name without "next.": the sector's own degree of freedom for one of the next sector.

    >>> own_name("next.tip"), own_name("tip")
    ('tip', 'tip')
    """
    return name.removeprefix(NEXT)


def read_cyclic(top: Section) -> list[Part]:
    """The number of sectors and the engine order as read: a list of one, or of none."""
    if "cyclic" not in top.data:
        return []
    section = top.table("cyclic", "")
    if section is None:
        return [{"sectors": np.nan, "engine_order": np.nan}]
    section.only(*names("cyclic"))
    for table, why in TABLES.items():
        if table in top.data:
            top.wrong(table, f"cannot be beside [cyclic]: {why}")
    found: Part = {key: section.number(key, RULES[key]) for key in ("sectors", "engine_order")}
    if (mistuning := read_mistuning(section, found["sectors"])) is not None:
        found["mistuning"] = mistuning
    if "base" in top.data and (why := _no_base(top, found["engine_order"])):
        top.wrong("base", f"cannot be beside [cyclic] {why}")
    return [found]


def _no_base(top: Section, order: float) -> str:
    """Why the base of a ring cannot move; empty if it can."""
    if "structure" not in top.data:
        return "and [modal]: needs [structure]"
    sweep = top.data.get("sweep")
    tables = [sweep, *(sweep.get("paired") or ())] if isinstance(sweep, Mapping) else []
    swept = any(isinstance(table, Mapping) and "cyclic.engine_order" in table for table in tables)
    return f"with an engine_order other than 0: {SHAKES}" if swept or order != 0.0 else ""


def ring_names(top: Section, own: Names | None) -> RingNames | None:
    """The names that contacts may use; None after a mistake."""
    if own is None:
        return None
    for name in own:
        if name.startswith(NEXT):
            top.wrong(own.key, f"{quoted(name)} is the name of a degree of freedom of the next sector")
    made = RingNames((*own, *(f"{NEXT}{name}" for name in own)))
    made.key = own.key
    return made


def only_own(top: Section, drafts: Mapping[str, list[Part]], dofs: RingNames | None) -> None:
    """Note forces and loads on the next sector, which has its own."""
    if dofs is None:
        return
    for table in ("force", "load"):
        for number, draft in enumerate(drafts[table]):
            if draft["dof"] is not None and draft["dof"][len(dofs.own) : len(dofs)].any():
                what = 'is of the next sector, which has its own; "next." is for contacts'
                top.wrong(f"{table}[{number}].dof", what)


def ring_of(modal: Part, cyclic: Part, unit: float) -> tuple[Modal, Ring]:
    """The modes of diameter 0, which the mean excites, and the ring; unit is rad/s per frequency unit."""
    dofs = tuple(modal["dofs"])
    sectors, order = int(cyclic["sectors"]), int(cyclic["engine_order"])
    diameter = modal["diameter"]
    shapes = modal["shapes"] / np.sqrt(modal["mass"])[:, None]
    place = {name: index for index, name in enumerate(dofs)}
    columns = [place[own_name(name)] for name in dofs]
    ahead = np.array([name.startswith(NEXT) for name in dofs])
    turn = np.exp(2j * np.pi * diameter / sectors)[:, None]
    whole = np.where(ahead, turn, 1.0) * shapes[:, columns]
    added = np.array(modal.get("flexible", np.zeros(diameter.size, dtype=bool)))
    ring = Ring(sectors, order, modal["frequency"] * unit, modal["damping"], whole, diameter, added)
    rest = diameter == 0
    at_rest = Modal(
        dofs, np.ones(int(rest.sum())), ring.frequency[rest], ring.damping[rest],
        np.ascontiguousarray(whole[rest].real), int(added[rest].sum()),
    )  # fmt: skip
    for array in (ring.frequency, ring.damping, ring.shapes, at_rest.shapes):
        array.flags.writeable = False
    return at_rest, ring


def check_diameters(curve: Scene, mistakes: Mistakes, where: str) -> bool:
    """Whether all harmonics of a curve excite modes; notes those that have none."""
    if curve.ring is None:
        return True
    before = mistakes.count
    for harmonic, diameter in curve.ring.lacking(
        sorted({0, *(curve.harmonics or (1,)), *(force.harmonic for force in curve.forces)})
    ).items():
        mistakes.add(where or "modal.nodal_diameter", lacks(curve.ring, harmonic, diameter))
    return mistakes.count == before


def note_of_stability(scene: Scene) -> list[str]:
    """Note on which disturbances decide whether the waves of a scene are stable."""
    rings = {one.ring.engine_order: one.ring for one in scene.each_curve() if one.ring is not None}
    if not rings:
        return []
    periods = sorted({ring.period for ring in rings.values()})
    each = f"{', '.join(map(str, periods))} sector{'s' * (periods != [1])}"
    return [
        "cyclic: stability is that of disturbances of the same travelling wave, which repeat as it does, "
        f"after {each}" + (": all that there are" if periods == [next(iter(rings.values())).sectors] else "")
    ]


def question_of_joints(scene: Scene) -> list[str]:
    """A question if nothing couples the sectors.

    Then all diameters have the same frequencies, and no contact reaches the next sector.
    """
    ring = scene.ring
    if ring is None:
        return []
    own = len(scene.modal.dofs) // 2
    reaches_next = any(one[own:].any() for contact in scene.contacts for one in contact.directions)
    families = [np.sort(ring.frequency[ring.diameter == n]) for n in np.unique(ring.diameter)]
    alike = len({one.size for one in families}) == 1 and bool(
        (np.ptp(families, axis=0) <= TOLERANCES.same_modes * families[0]).all()
    )
    if reaches_next or len(families) == 1 or not alike:
        return []
    return [
        Question(
            "cyclic: is something missing? Nothing joins the sectors: the structure has no coupling to the "
            'next one, and no contact names its "next." degrees of freedom. So each moves alone, as one '
            "without [cyclic]"
        )
    ]


def lacks(ring: Ring, harmonic: int, diameter: int) -> str:
    """A sentence on a harmonic whose nodal diameter has no modes."""
    who = "the mean" if harmonic == 0 else f"harmonic {harmonic} of engine order {ring.engine_order}"
    return f"there are no modes of nodal diameter {diameter}, which {who} meets"


def own_names(dofs: Names | None) -> Names | None:
    """The degrees of freedom that results can have: for a sector, its own."""
    return dofs.own if isinstance(dofs, RingNames) else dofs
