"""``fcm plot modes SCENE``: the modes of a scene and their participation, before anything is solved."""

from __future__ import annotations

import json
from typing import Any

import click

from fcm.cli.columns import OF_OVERDAMPED, OVERDAMPED, aligned, number, ratio
from fcm.cli.files import largest_file_option
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import scene_argument

_FRICTION = (
    "the damping ratio that friction can add to each resonance, estimated for closed contacts{}.\n"
    "open: the mode without contacts of the most alike shape, MAC: how alike, 1 the same; - if below {:g}.\n"
    "most in: the contact that takes the largest share of the energy; n_0: its preload then"
)
_OF_PAIRS = "; n_0 is that of a pair"
_OF_TOTALS = "; n_0 is the total of all pairs"
_OPENS = "*"  # beside a preload with which contacts would open
_OF_OPENING = (
    f"{_OPENS} contacts would open with this preload, so that it does not hold, nor does the damping: "
    "[optimum] finds the best"
)
_NOT_MOVED = "- of n_0: the scene's forces do not move the mode"
_FLOATS = "'"  # beside a stiffness where rigid-body modes move
_OF_FLOATING = f"{_FLOATS} of elastic modes alone: rigid-body modes move along it; - where no other does"
_SPRINGS = (("k_u", "tangential"), ("k_v", "normal"))
_STIFFNESS = (
    "the stiffness of each contact{}, beside that of the structure along and across its faces "
    "without contacts:"
)


@click.command()
@scene_argument
@click.option("--all", "every", is_flag=True, help="Of a ring, list also diameters that no force meets.")
@click.option("--json", "to_json", is_flag=True, help="Print JSON instead of a table.")
@largest_file_option
@pass_messages
def modes(messages: Messages, scene: str, every: bool, to_json: bool, largest_file: int) -> None:
    """List the modes of SCENE: frequency, damping, mass, and participation at contacts and forces.

    The participation is the share of a mode in the static flexibility along a contact or a force. Modes that
    stand for the flexibility of those left out are marked "flexibility". Of a ring of sectors they are listed
    by nodal diameter, with the share among the modes of the same. They are those of the diameters that forces
    meet; --all has the others, too, and `fcm plot campbell` draws them. The other tables are not made of it.

    A second table has the resonances while all contacts stick. Beside each stands the mode without contacts
    of the most alike shape, by the modal assurance criterion with the mass. Modes of one frequency count
    together. By number they would not belong together where only contacts hold a body.

    It has the greatest damping ratio that friction can add to each, estimated by one harmonic. Contacts stay
    closed, at their best preload, with the same share of slip. The contact with the greatest part is "most
    in". Its preload that gives this damping, in resonance with the scene's forces, is "n_0". It is marked
    where contacts would open with it. A ratio of 1 and more is marked as overdamped. A mode that the forces
    do not move has no preload, and none that is overdamped has a ratio then.

    A third table has the stiffness of each contact, and that of the structure there, by a unit load without
    contacts. A contact of a hundredth of it changes little. With a hundred times as much it is as good as
    rigid. Where a rigid-body mode moves along it, the load moves it without limit. Then it is that of the
    elastic modes alone, and marked.

    This is a list, and draws no picture. SCENE may be without [response] and [[force]]. Below the list
    stands what was read: matrices, their rows, entries and symmetry, and rigid bodies. Frequencies stand
    there in both units, with those while all contacts stick. Frequencies that look as if units were mixed
    are named.
    """
    from fcm.scene import load_scene
    from fcm.scene.listing import listing

    found = listing(load_scene(scene, largest_file=largest_file, solved=False))
    count_of_all = len(found["modes"])
    if not (every or to_json):
        found["modes"] = [mode for mode in found["modes"] if mode.get("met", True)] or found["modes"]
    click.echo(json.dumps(found, indent=2, allow_nan=False) if to_json else as_table(found))
    if not to_json:
        if any(share is None for mode in found["modes"] for share in mode["participation"].values()):
            messages.info("- no share: under a static load there the rigid-body modes move without limit")
        count, shown = len(found["modes"][0]["participation"]), len(_shown(found))
        if shown < count:
            messages.info(f"shown are {shown} of {count} directions of contacts and forces: --json has all")
        if missing := len(found["modes"]) - len(_listed(found["modes"])):
            stand = "mode stands" if missing == 1 else "modes stand"
            messages.info(f"{missing} more {stand} for flexibility: --json has all")
        if others := count_of_all - len(found["modes"]):
            messages.info(
                f"{others} more modes are of nodal diameters that no force meets: --all has them. Harmonics "
                "of friction may meet them"
            )
        if "resonances" not in found:
            messages.info(
                "the tables of damping by friction and of stiffness are not made of a ring, whose modes "
                "travel. A [sweep] of n_0, first with --harmonics 1, shows which preload is best"
            )
        messages.info(f"shapes: {found['normalisation']}")
        for text in found["read"]:
            messages.info(f"read: {text}")
        for note in found["notes"]:
            messages.note(note)
    for warning in found["warnings"]:
        messages.warning(warning)


def as_table(found: dict[str, Any]) -> str:
    """Table with a line for each mode, with as many directions as fit; then a line for each resonance."""
    parts = [_lines(found, _shown(found)), _resonances(found), _stiffness(found)]
    return "\n\n".join(filter(None, parts))


def _stiffness(found: dict[str, Any]) -> str:
    """Table of the stiffness of contacts and of the structure at them; empty without contacts.

    With many contacts, those with the greatest ratio are listed.
    """
    every = found.get("stiffness", {})
    if not every:
        return ""

    rows = []
    for name, one in every.items():
        pairs = [(one[k], one[f"elastic_{way}"], one[f"structure_{way}"]) for k, way in _SPRINGS]
        rows.append((name, [None if own is None else k / own for k, own, _ in pairs], pairs))
    kept = sorted(rows, key=lambda row: -max((value or 0.0) for value in row[1]))[: SENTENCES.rows]
    heads = ["k_u", "along", "ratio", "k_v", "across", "ratio"]
    lines = [["contact", *heads]]
    for name, ratios, pairs in rows:
        cells = []
        for (k, own, held), beside in zip(pairs, ratios, strict=True):
            mark = _FLOATS if own is not None and held is None else ""
            cells += [
                f"{k:.4g}",
                *("-" if value is None else f"{value:.4g}{mark}" for value in (own, beside)),
            ]
        lines += [[name, *cells]] if (name, ratios, pairs) in kept else []
    floats = f"\n{_OF_FLOATING}" if any(_FLOATS in cell for line in lines[1:] for cell in line[1:]) else ""
    more = f"\nand {len(rows) - len(kept)} more contacts: --json has all" if len(rows) > len(kept) else ""
    length, force = (found["units"][of] for of in ("length", "force"))
    said = _STIFFNESS.format(f" [{force}/{length}]" if length and force else "")
    return f"{said}\n{aligned(lines, left=0)}{floats}{more}"


def _resonances(found: dict[str, Any]) -> str:
    """The damping that friction can add to each of the first resonances; empty without friction."""
    every = found.get("resonances", [])
    if not any(one["friction_damping"] for one in every):
        return ""
    unit = found["frequency_unit"]
    forced = any(name.startswith("force.") for name in found["modes"][0]["participation"])
    force = found["units"]["force"]
    heads = ["friction adds", "most in", "", f"n_0 [{force}]" if force else "n_0"]
    totals = found["preload_shares"]
    rows = [["resonance", f"stuck at {unit}", f"open at {unit}", "MAC", *heads]]
    for number_of, one in enumerate(every, 1):
        name, share = max(one["by_contact"].items(), key=lambda item: item[1])
        whole = one["preload"][name] / totals.get(name, 1.0)
        preload = f"{whole:.2g}" if whole else "-"
        preload += _OPENS if one["opens"] else ""
        most = [name, f"{100.0 * share:.0f} %", preload] if one["friction_damping"] else ["-", "", ""]
        adds = ratio(one["friction_damping"], 2)
        if adds.endswith(OVERDAMPED) and forced and not one["excited"]:
            adds, most = "-", ["-", "", ""]
        rows.append(
            [
                str(number_of),
                number(one["stuck"]),
                number(one["open"]) if one["mac"] >= SENTENCES.least_alike else "-",
                f"{one['mac']:.3f}",
                adds,
                *most,
            ]
        )
    marks = [_NOT_MOVED] if forced and not all(one["excited"] for one in every) else []
    marks += [_OF_OPENING] if any(one["opens"] for one in every) else []
    marks += [OF_OVERDAMPED] if any(row[4].endswith(OVERDAMPED) for row in rows) else []
    pairs = {row[5] for row in rows if row[5] in found["of_pairs"]}
    of = _OF_TOTALS if pairs & totals.keys() else _OF_PAIRS if pairs else ""
    if pairs & totals.keys() and pairs - totals.keys():
        of += f", but of {', '.join(sorted(pairs - totals.keys()))} that of a pair"
    said = _FRICTION.format(of, SENTENCES.least_alike)
    return "\n".join([said, aligned(rows, left=3), *marks])


def _lines(found: dict[str, Any], directions: list[str]) -> str:
    ring = "nodal_diameter" in found["modes"][0]
    header = [
        "mode",
        *(["diameter"] if ring else []),
        f"at {found['frequency_unit']}",
        "damping",
        "mass",
        *map(_short, directions),
        "",
    ]
    rows = [header]
    for mode in _listed(found["modes"]):
        shares = (mode["participation"][name] for name in directions)
        rows.append(
            [
                str(mode["mode"]),
                *([str(mode["nodal_diameter"])] if ring else []),
                number(mode["frequency"]),
                f"{mode['damping']:.4g}",
                f"{mode['mass']:.4g}",
                *("-" if share is None else f"{100 * share:.2f} %" for share in shares),
                "" if mode["kind"] == "mode" else mode["kind"],
            ]
        )
    return aligned(rows, left=1)


def _listed(modes: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The modes that have a line: all but those for flexibility, of which only the first few do."""
    from fcm.scene.listing import FLEXIBILITY

    flexible = [i for i, mode in enumerate(modes) if mode["kind"] == FLEXIBILITY]
    beyond = set(flexible[SENTENCES.flexible :])
    return [mode for i, mode in enumerate(modes) if i not in beyond]


def _shown(found: dict[str, Any]) -> list[str]:
    """The directions that fit on a line: the first contact's and a force, then other forces and contacts."""
    every = list(found["modes"][0]["participation"])
    contacts = [name for name in every if name.startswith("contact.")]
    whole = 1 + next((i for i, name in enumerate(contacts) if name.endswith(".normal")), -1)
    forces = [name for name in every if name not in contacts]
    for most in range(SENTENCES.directions, 0, -1):
        beside = min(SENTENCES.forces, most - 1, max(most - whole, 1))
        few = forces[: max(beside, most - len(contacts))]
        chosen = contacts[: most - len(few)] + few
        if max(map(len, _lines(found, chosen).splitlines())) <= SENTENCES.width:
            break
    return chosen


def _short(direction: str) -> str:
    """A direction without the prefix ``contact.``.

    >>> _short("contact.shroud.tangential"), _short("force.71x")
    ('shroud.tangential', 'force.71x')
    """
    return direction.removeprefix("contact.")
