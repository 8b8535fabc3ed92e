"""Loads a scene from a TOML file, a bundled name or a dict, and checks it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fcm.files import NOT_THERE, no_file
from fcm.model.scene import Scene
from fcm.scene.contact_stiffness import notes_of_stiffness
from fcm.scene.cyclic import (
    check_diameters,
    note_of_stability,
    only_own,
    own_names,
    question_of_joints,
    read_cyclic,
)
from fcm.scene.draft import Draft, forces_of, modes_of
from fcm.scene.errors import Mistakes, SceneError, choices, kind, quoted, suggestion
from fcm.scene.excitation import load_of, note_of_mass, notes_of_loads, read_base, read_loads
from fcm.scene.files import Files
from fcm.scene.force_reach import question_of_forces
from fcm.scene.keys import names
from fcm.scene.linear import (
    check_matrices,
    read_linear,
    read_output,
    reported_of,
    with_base,
    with_exact_rigid_modes,
    with_modes,
    without_others,
)
from fcm.scene.mistuning import KEY as MISTUNING
from fcm.scene.mistuning import MistuningError, drawn_rings, read_blade, tuned_sweep, whole_ring
from fcm.scene.modal import notes_of_modes_above
from fcm.scene.node_pairs import notes_of_shares
from fcm.scene.optimum import read_optimum
from fcm.scene.options import FILES, MESSAGES, TOLERANCES
from fcm.scene.pair_sides import notes_of_sides
from fcm.scene.parts import (
    contact_of,
    note_of_harmonics,
    read_contacts,
    read_forces,
    read_harmonics,
    read_response,
    read_units,
    response_table,
    unread_tables,
)
from fcm.scene.plane import check_plane, notes_of_planes
from fcm.scene.questionable_values import questions
from fcm.scene.rigid_places import notes_of_places
from fcm.scene.schedule import note_of_start, read_schedule, read_start, with_schedule
from fcm.scene.section import Parts, Section
from fcm.scene.shared_normal import note_of_shared_normals, notes_of_slopes
from fcm.scene.size_notices import SizeNotices
from fcm.scene.sweep import combinations, curves_of, read_sweep
from fcm.scene.toml import read_toml
from fcm.scene.unclosed_gaps import question_of_constant_loads, questions_of_gaps
from fcm.units import UNIT

NOT_IN_PLANE = (
    "simulates contacts on a line alone, between whose events the structure is linear. A contact with two "
    "tangential directions has a response by harmonics, without [[schedule]]"
)


def bundled_scenes() -> tuple[str, ...]:
    """Names of the scenes that come with fcm, then those of collections such as "extreme/stiff-normal".

    >>> "yang1998" in bundled_scenes(), "extreme/stiff-normal" in bundled_scenes()
    (True, True)
    """
    folder = _bundled()
    plain = sorted(path.stem for path in folder.glob("*.toml"))
    collected = sorted(f"{path.parent.name}/{path.stem}" for path in folder.glob("*/*.toml"))
    return (*plain, *collected)


def _bundled() -> Path:
    return Path(__file__).parents[1] / "scenes"


def path_of(path_or_name: str | Path) -> Path:
    """The file of a scene, given by its path or bundled name; SceneError if there is none."""
    bundled = str(path_or_name) in bundled_scenes()
    return _bundled() / f"{path_or_name}.toml" if bundled else _there(path_or_name)


def load_scene(
    path_or_name: str | Path,
    *,
    largest_file: int = FILES.largest,
    every_row: bool = False,
    solved: bool = True,
    notices: SizeNotices | None = None,
) -> Scene:
    """The scene of a TOML file or a bundled name; SceneError lists every mistake.

    largest_file: greatest unpacked size [byte] of a file of modes or matrices. every_row: keep all rows of
    matrices; otherwise only those that are reported or carry contacts, forces or loads. solved: whether
    [response] and [[force]] are required. notices: announces draws and curves that take much time or memory.

    >>> scene = load_scene("yang1998")
    >>> scene.modal.dofs, scene.contacts[0].mu, len(scene.curves)
    (('u', 'v'), 0.4, 10)
    >>> scene.curves[0].parameters
    {'contact.shroud.n_0': 100.0}
    """
    path = path_of(path_or_name)
    scene = scene_from_dict(
        read_toml(path, str(path_or_name)),
        str(path_or_name),
        path.parent,
        largest_file=largest_file,
        every_row=every_row,
        solved=solved,
        notices=notices,
    )
    return replace(scene, files=(path, *scene.files))


def scene_from_dict(
    data: Mapping[str, Any],
    name: str = "scene",
    folder: str | Path = ".",
    *,
    largest_file: int = FILES.largest,
    every_row: bool = False,
    solved: bool = True,
    notices: SizeNotices | None = None,
) -> Scene:
    """The scene of a dict with the keys of a file; files of modes are relative to the folder.

    The other arguments are those of `load_scene`.

    >>> modal = {"dofs": ["u"], "frequency": [1.0], "damping": 0.01, "shapes": [[1.0]]}
    >>> force = [{"dof": "u", "amplitude": 1.0}]
    >>> data = {"modal": modal, "force": force, "response": {"frequency": [0.5, 1.5]}}
    >>> scene_from_dict(data).frequency_range
    (0.5, 1.5)
    """
    mistakes = Mistakes(name, notices)
    top = Section(data, "", mistakes)
    if not data:
        mistakes.add("", "is empty; a scene has [modal], [[contact]], [[force]] and [response]")
        mistakes.raise_if_any()
    top.only(*names(""))
    files = Files(Path(folder), largest_file)
    fields = _read(top, files, _Reading(every_row, solved))
    mistakes.raise_if_any()
    try:
        scene = _made(name, fields, notices, solved)
    except MistuningError as error:
        mistakes.add(MISTUNING, str(error))
        mistakes.raise_if_any()
    if scene.exchanged and _in_doubt(scene):
        from fcm.scene.reduction import in_each_others_place

        top.wrong("structure", in_each_others_place(scene.exchanged))
        mistakes.raise_if_any()
    scene = replace(scene, files=tuple(dict.fromkeys(files.read)))
    _check_curves(scene, mistakes)
    return scene


class _Reading(NamedTuple):
    """Arguments of `load_scene` on how a scene is read."""

    every_row: bool
    solved: bool


def _read(top: Section, files: Files, reading: _Reading) -> dict[str, Any]:
    """The fields of a scene that are read from its keys, and the draft from which the others are built."""
    unit = _unit(top)
    response = response_table(top, reading.solved)
    ends, step = read_response(top, response, unit)
    harmonics, accuracy = read_harmonics(response)
    schedule = read_schedule(top, unit)
    ends_of_forces = with_schedule(ends, schedule)
    parts, reported, asked, notes = _parts(top, files, unit, response, ends_of_forces, reading)
    if schedule and any("second" in one for one in parts["contact"]):
        top.wrong("schedule", NOT_IN_PLANE)
    start = read_start(top, parts)
    draft = Draft(parts, tuple(read_sweep(top, parts, drawn_rings(parts))))
    units = read_units(top)
    fit, notes_of_fit = None, list[str]()
    if "fit" in top.data:
        from fcm.scene.fit import notes_of_data, read_fit  # imports the readers of measured data

        fit = read_fit(top, files, draft, reported or tuple(parts["modal"]["dofs"] or ()), unit)
        notes_of_fit = notes_of_data(fit, ends, unit)
    notes = [
        *files.noted,
        *notes,
        *note_of_mass(files.masses, *units, floats=_floats(parts), mesh=any(files.meshes)),
        *notes_of_loads(parts["load"], units[1]),
        *questions(top, parts, draft.swept),
    ]
    return {
        "title": top.text("title", ""),
        "units": units,
        "frequency_unit": unit,
        "frequency_range": ends,
        "max_step": step,
        "harmonics": harmonics,
        "accuracy": accuracy,
        "schedule": schedule,
        "of_matrices": "structure" in top.data,
        "exchanged": parts["modal"].get("exchanged", 0.0),
        "start": start,
        "reported": reported,
        "output": asked,
        "notes": (*notes, *notes_of_fit),
        "read": tuple(files.said),
        "interfaces": tuple(files.interfaces),
        "optimum": read_optimum(top, draft, reported or tuple(parts["modal"]["dofs"] or ())),
        "fit": fit,
        "draft": draft,
    }


def _made(name: str, fields: dict[str, Any], notices: SizeNotices | None, solved: bool) -> Scene:
    """The scene built from fields without mistakes, with its curves and notes."""
    draft: Draft = fields["draft"]
    modal, ring = modes_of(draft.parts, fields["frequency_unit"])
    scene = Scene(
        name=name,
        tuned=_tuned(name, fields, solved),
        modal=modal,
        ring=ring,
        contacts=tuple(map(contact_of, draft.parts["contact"])),
        forces=forces_of(draft.parts),
        loads=tuple(map(load_of, draft.parts["load"])),
        **fields,
    ).started()
    if notices is not None:
        notices.curves(scene, curves_of(draft.swept))
    curves = tuple(draft.curve(scene, values) for values in combinations(draft.swept))
    scene = replace(scene, curves=curves)
    return replace(
        scene,
        notes=(
            *scene.notes,
            *_notes_of_modes(scene),
            *(notes_of_modes_above(scene) if solved and not scene.of_matrices else ()),
            *(note_of_stability(scene) if solved else ()),
            *question_of_joints(scene),
            *note_of_harmonics(scene.forces),
            *note_of_start(scene),
            *note_of_shared_normals(scene),
            *notes_of_slopes(scene),
            *notes_of_planes(scene),
            *notes_of_stiffness(scene),
            *question_of_forces(scene),
            *questions_of_gaps(scene),
            *question_of_constant_loads(scene),
        ),
    )


RIGID = 6  # number of rigid-body modes of a free body


def _floats(parts: Parts) -> bool:
    """Whether a structure has at least six rigid-body modes."""
    frequency = parts["modal"].get("frequency")
    return frequency is not None and int((np.asarray(frequency, dtype=np.float64) == 0.0).sum()) >= RIGID


def _in_doubt(scene: Scene) -> bool:
    from fcm.scene.listing import resonance_doubt  # scipy, which other scenes do without

    return bool(resonance_doubt(scene))


def _notes_of_modes(scene: Scene) -> list[str]:
    if not scene.of_matrices or not scene.contacts:
        return []
    from fcm.scene.listing import notes_of_diameters, notes_of_modes

    return notes_of_modes(scene) if scene.ring is None else notes_of_diameters(scene)


def _tuned(name: str, fields: dict[str, Any], solved: bool) -> Scene | None:
    """The tuned ring of a mistuned one, as a scene of one sector; None if there is no mistuning."""
    draft: Draft = fields["draft"]
    if not draft.parts.get("whole"):
        return None
    whole = draft.parts["whole"][0]
    of_sector = Draft(whole["tuned"], tuned_sweep(whole["tuned"], draft.swept))
    nothing = {"notes": (), "read": (), "optimum": None, "fit": None}
    of_tuned = {"draft": of_sector, "reported": whole["reported"], "output": whole["output"]}
    return _made(name, fields | nothing | of_tuned, None, solved)


def _parts(
    top: Section,
    files: Files,
    unit: str,
    response: Section | None,
    ends: tuple[float, float],
    reading: _Reading,
) -> tuple[Parts, tuple[str, ...], tuple[str, ...], list[str]]:
    """The drafts of modes, contacts and forces; the reported and the requested dofs; and notes."""
    cyclic = read_cyclic(top)
    modal, matrices = read_linear(top, files, unit, cyclic)
    read_blade(top, files, cyclic, modal["dofs"], matrices)
    parts: Parts = {"modal": modal, "cyclic": cyclic}
    parts["contact"] = read_contacts(top, modal["dofs"], files)
    parts["force"] = read_forces(top, modal["dofs"], reading.solved)
    ends = (ends[0], ends[1] * max((one["harmonic"] for one in parts["force"]), default=1))
    parts["load"] = read_loads(top, files, modal["dofs"], "structure" in top.data)
    parts["unread"] = unread_tables(top, parts)
    parts["base"] = read_base(top, own_names(modal["dofs"]), "structure" in top.data)
    if cyclic:
        only_own(top, parts, modal["dofs"])
    output = read_output(response, own_names(modal["dofs"])) if response is not None else []
    if top.mistakes.count:
        if matrices is not None:
            check_matrices(top, matrices, cyclic, ends)
        return parts, (), (), []
    if matrices is not None:
        sides = notes_of_sides(parts["contact"], matrices.K)
        parts, notes = with_modes(top, parts, matrices, output, ends, unit)
        notes += sides
    else:
        parts, notes = with_exact_rigid_modes(with_base(parts), ends, unit)
        notes = [*modal["notes"], *notes]
    notes = [*notes, *notes_of_shares(parts["contact"])]
    if not cyclic:
        notes += notes_of_places(parts["modal"], files.interfaces)
    if top.mistakes.count:
        return parts, (), (), []
    asked = response is not None and "output" in response.data
    reported = reported_of(parts, output, asked)
    mistuned = bool(cyclic) and "mistuning" in cyclic[0]
    if matrices is not None and (mistuned or not reading.every_row):
        parts = without_others(top, parts, reported)
    if not mistuned:
        return parts, reported, tuple(output), notes
    parts, reported, more = whole_ring(top, parts, reported, output)
    of_ring = tuple(name for name in reported if name.rpartition("@")[0] in output)
    return parts, reported, of_ring, [*notes, *more]


def _check_curves(scene: Scene, mistakes: Mistakes) -> None:
    """Checks each curve as a whole: its harmonics, modal masses, and that forces and contacts move something.

    A mistake in all curves of a sweep is reported once, without the swept values.
    """
    curves, found = scene.each_curve(), list[tuple[str, str]]()
    for curve in curves:
        where = ", ".join(f"{key} = {value:g}" for key, value in curve.parameters.items())
        where = f"sweep with {where}" if where else ""
        for contact in curve.contacts:
            check_plane(contact, curve.modal.dofs, mistakes, where)
        if check_diameters(curve, mistakes, where):
            found += [(where, what) for what in dict.fromkeys(_faults_of_curve(curve))]
    count = Counter(what for _, what in found)
    everywhere = [what for what in count if count[what] == len(curves)]
    for where, what in [("", what) for what in everywhere] + [x for x in found if x[1] not in everywhere]:
        mistakes.add(where, what)
    mistakes.raise_if_any()


def _faults_of_curve(curve: Scene) -> Iterator[str]:
    if curve.has_range and curve.forces and not _moved(curve):
        yield f"{_unmoved(curve)}, so the response is zero"
    masses = curve.modal.mass
    if masses.size and masses.max() > TOLERANCES.mass_ratio * masses.min():
        low, high = masses.min(), masses.max()
        what = f"the modal masses, from {low:g} to {high:g}, differ by more than {TOLERANCES.mass_ratio:g}"
        yield f"{what}: beside the light ones nothing is left of the heavy ones"
    for contact in curve.contacts:
        if not all(direction.any() for direction in contact.directions[:-1]):
            yield f"contact {quoted(contact.name)} has only zero tangential weights"


def _unmoved(curve: Scene) -> str:
    """Sentence on why the forces of a curve move nothing."""
    if any(force.amplitude for force in curve.forces) or curve.draft is None:
        return "the forces move no mode"
    parts = curve.draft.parts
    zeros = [f"force[{i}].amplitude" for i in range(len(parts["force"]))]
    zeros += ["base.acceleration"] * len(parts["base"])
    if len(zeros) > MESSAGES.groups:
        return f"the amplitudes of all {len(zeros)} forces are 0"
    return f"{' and '.join(zeros)} {'is' if len(zeros) == 1 else 'are'} 0"


def _moved(curve: Scene) -> bool:
    """Whether the forces together excite any mode, beyond the rounding of their sum."""
    return any(_moved_by(curve, harmonic) for harmonic in {force.harmonic for force in curve.forces})


def _moved_by(curve: Scene, harmonic: int) -> bool:
    """Whether the forces of one harmonic together excite any mode, beyond rounding."""
    shapes = curve.modal.shapes if curve.ring is None else curve.ring.modes(harmonic)[2]
    forces = [force for force in curve.forces if force.harmonic == harmonic]
    pushes = [shapes @ (force.amplitude * force.direction) for force in forces]
    size = np.sum([np.abs(push) for push in pushes], axis=0)
    turned = [push * np.exp(1j * force.phase) for push, force in zip(pushes, forces, strict=True)]
    return bool((np.abs(np.sum(turned, axis=0)) > TOLERANCES.cancelled * size).any())


def _unit(top: Section) -> str:
    unit = top.data.get("frequency_unit", "rad/s")
    if isinstance(unit, str) and unit in UNIT:
        return unit
    what = quoted(unit) if isinstance(unit, str) else kind(unit)
    word = unit if isinstance(unit, str) else ""
    top.wrong("frequency_unit", f"must be {' or '.join(map(quoted, UNIT))}, is {what}", word, UNIT)
    return "rad/s"


def _there(path_or_name: str | Path) -> Path:
    """Path of a scene's file, which must exist."""
    path, what = Path(path_or_name), no_file(Path(path_or_name))
    if what == NOT_THERE:
        raise SceneError(str(path), [_not_there(str(path))])
    if what.startswith(("cannot", "is a loop")):  # for folders and pipes the reader reports more
        raise SceneError(str(path), [what])
    return path


def _not_there(path: str) -> str:
    names = bundled_scenes()
    hint = suggestion(path.removesuffix(".toml"), names)
    return f"no such file, and not a bundled scene; those are {choices(names)}{hint}"
