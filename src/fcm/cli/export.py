"""Export to other programs: motions on their mesh, contact forces, modal amplitudes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.files import output_option
from fcm.cli.messages import Messages
from fcm.cli.options import FiniteRange

if TYPE_CHECKING:
    from fcm.cli.respond_options import Asked
    from fcm.mesh import Mesh
    from fcm.model.scene import Scene
    from fcm.results.motions import ResponseMotion
    from fcm.results.result import Response

UNIVERSAL, HDF5 = (".uff", ".unv"), (".h5", ".hdf5")
_MISTUNED = "it writes one sector, and those of a mistuned ring differ; -o FILE has the displacements of all"
_RING = (
    "a ring's sector moves in modes that travel around it; its contact forces alone are exported "
    "(--contact-forces), and -o FILE has its displacements"
)


def export_options(command: Any) -> Any:
    """Decorator that adds the options of export to a command."""
    options: list[Callable[[Any], Any]] = [
        output_option(
            "--export", endings=(".vtu", *UNIVERSAL, *HDF5),
            help="Write the displacements of all rows at the peaks, complex by harmonic: .vtu for ParaView "
            "(needs --mesh), .uff with datasets 55 and 58, .h5.",
        ),
        click.option(
            "--mesh", type=click.Path(exists=True, dir_okay=False, readable=True, path_type=Path),
            metavar="FILE",
            help="With --export: where the nodes are: .inp of CalculiX or Abaqus, .bdf, .msh, or .csv with "
            "the columns node,x,y,z. A .vtu has surfaces only of a mesh with elements.",
        ),
        output_option(
            "--contact-forces", endings=(".csv",),
            help="Write the contact forces at the peaks, by harmonic, as CSV; -o FILE has them then, too.",
        ),
        click.option(
            "--modal-amplitudes", is_flag=True,
            help="Write the displacements of the modes at the peaks, by harmonic, to -o FILE.",
        ),
        click.option(
            "--motion-at", type=FiniteRange(min=0.0, min_open=True), multiple=True, metavar="F",
            help="Instead of at the peaks, export where the curves pass this frequency; again for more. With "
            "--mode where the modal amplitude is this, instead of in resonance with the scene's forces.",
        ),
    ]  # fmt: skip
    for option in reversed(options):
        command = option(command)
    return command


def check_options(asked: Asked) -> None:
    """Raise a usage error if options exclude or need one another."""
    given = {
        "--export": asked.export is not None,
        "--contact-forces": asked.contact_forces is not None,
        "--modal-amplitudes": asked.modal_amplitudes,
    }
    wanted = next((name for name, one in given.items() if one), "")
    if asked.mesh is not None and asked.export is None:
        raise click.UsageError("--mesh is of no use without --export FILE.")
    if asked.motion_at and not wanted:
        raise click.UsageError(f"--motion-at needs one of {', '.join(given)}.")
    if asked.modal_amplitudes and asked.output is None:
        raise click.UsageError("--modal-amplitudes go to the netCDF file; give -o FILE.")
    if asked.export is not None and asked.export.suffix.lower() == ".vtu" and asked.mesh is None:
        raise click.UsageError("--export to .vtu needs --mesh FILE: .inp, .bdf, .msh, or .csv (node,x,y,z).")
    others = {
        "--method exact": (
            asked.method == "exact",
            "it writes motions by their harmonics, which harmonic balance has; leave --method out",
        ),
        "--level": (
            asked.level is not None and asked.mode is None,
            "it is of curves against the frequency; give the forces that amplitude, and leave --level out",
        ),
        "--track": (
            asked.track is not None,
            "it is of curves against the frequency; give the scene the number, and leave --track out",
        ),
        "--peaks-only": (asked.peaks_only, "it is taken from points of the curves; leave --peaks-only out"),
    }
    for option, (one, why) in others.items():
        if wanted and one:
            raise click.UsageError(f"{wanted} is of no use with {option}: {why}.")


@dataclass
class Exporting:
    """Export of a scene with all its rows, after its response is known."""

    messages: Messages
    scene: Scene
    asked: Asked
    mesh: Mesh | None
    motions: Sequence[ResponseMotion] = ()

    @property
    def files(self) -> list[tuple[Path, Callable[[Response, Path], None]]]:
        """Path of each exported file, and the function that writes it."""
        found = [(self.asked.export, self._export), (self.asked.contact_forces, self._forces)]
        return [(path, write) for path, write in found if path is not None]

    def take(self, response: Response, scene: Scene) -> None:
        """Take the motions of a response; `scene` has only the degrees of freedom in use."""
        from fcm.export import motions_of
        from fcm.results.motions import ResponseMotions

        if response.tracking is not None and response.tracking.optima:
            from fcm.response.optimum import scenes_at

            optima = response.tracking.optima
            scene = replace(scene, curves=scenes_at(scene, optima))
            self.scene = replace(self.scene, curves=scenes_at(self.scene, optima))
        self.motions = motions_of(response, scene, self.asked.motion_at)
        forces = self.asked.contact_forces is not None
        response.motions = ResponseMotions(tuple(self.motions), forces, self.asked.modal_amplitudes)

    def _forces(self, response: Response, path: Path) -> None:
        from fcm.export.forces_csv import write_forces
        from fcm.files import replacing

        with replacing(path) as temporary:
            write_forces(self.motions, response, temporary)

    def _export(self, response: Response, path: Path) -> None:
        from fcm.files import replacing

        ending = path.suffix.lower()
        with replacing(path) as temporary:
            if ending == ".vtu":
                from fcm.export.vtu import write_vtu

                assert self.mesh is not None  # see check_options
                write_vtu(self.motions, self.scene, self.mesh, temporary)
            elif ending in HDF5:
                from fcm.export.hdf5 import write_hdf5

                write_hdf5(self.motions, self.scene, self.mesh, temporary)
            else:
                from fcm.export.universal import write_universal

                write_universal(self.motions, response, self.scene, self.mesh, temporary)


def exporting(messages: Messages, scene: Scene, asked: Asked) -> Exporting | None:
    """The requested export of a scene with all its rows; None if there is none.

    Raises ExportError for any obstacle before the calculation begins.
    """
    if asked.export is None and asked.contact_forces is None and not asked.modal_amplitudes:
        return None
    from fcm.export.rows import ExportError, StructureRows, check_library, check_mesh, check_nodes

    if scene.fit is not None:
        raise ExportError(
            f"{scene.name}: motions are exported of a scene as it is; write what [fit] found into it"
        )
    if not scene.has_range and asked.mode is None:
        raise ExportError(f"{scene.name}: motions are exported of curves, and it has no [response]")
    _check_motion_at(scene, asked)
    if scene.ring is not None and (asked.export is not None or asked.modal_amplitudes):
        raise ExportError(f"{scene.name}: {_RING}")
    if scene.tuned is not None and asked.export is not None:
        raise ExportError(f"{scene.name}: {_MISTUNED}")
    mesh = None
    if asked.mesh is not None:
        mesh = _mesh(asked.mesh)
        for note in check_mesh(StructureRows.of(scene), mesh, str(asked.mesh)):
            messages.info(note)
        if not mesh.cells and asked.export is not None and asked.export.suffix.lower() == ".vtu":
            messages.info(
                f"{asked.mesh}: it has no elements, so {asked.export} has points alone; an .inp, a .bdf or "
                "an .msh has surfaces"
            )
    if asked.export is not None:
        if asked.export.suffix.lower() in UNIVERSAL:
            check_nodes(StructureRows.of(scene))
        check_library(asked.export.suffix.lower())
    return Exporting(messages, scene, asked, mesh)


def _check_motion_at(scene: Scene, asked: Asked) -> None:
    """Raise ExportError if a frequency, or with --mode a modal amplitude, is outside the range."""
    from fcm.export.rows import ExportError
    from fcm.units import UNIT, in_unit

    if asked.mode is not None:
        assert asked.level is not None  # --mode needs it
        (low, high), factor, unit = asked.level, 1.0, "(modal amplitude)"
        ends = f"{low:g} to {high:g} {unit}"
    else:
        (low, high), unit = scene.frequency_range, scene.frequency_unit
        factor = UNIT[unit]
        ends = f"{' to '.join(f'{float(in_unit(end, unit)):g}' for end in (low, high))} {unit}"
    for one in asked.motion_at:
        if not low <= one * factor <= high:
            raise ExportError(f"--motion-at {one:g}: the range is {ends}")


def _mesh(path: Path) -> Mesh:
    from fcm.export.rows import ExportError
    from fcm.mesh import MeshError, read_mesh

    try:
        return read_mesh(path)
    except MeshError as error:
        raise ExportError("\n".join(f"{path}: {fault}" for fault in error.faults)) from None
