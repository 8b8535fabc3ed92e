"""``fcm plot campbell SCENE``: frequencies by nodal diameter and engine orders of a ring of sectors."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from fcm.cli.drawing import ENDINGS, picture_of, save_picture
from fcm.cli.files import largest_file_option, output_option, wrote
from fcm.cli.limits import SENTENCES
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import scene_argument

if TYPE_CHECKING:
    from fcm.model.scene import Scene


@click.command()
@scene_argument
@output_option(
    "-o", "--output", endings=ENDINGS,
    help="The picture to write: .png, .svg or .pdf.  [default: SCENE with the ending -campbell.png]",
)  # fmt: skip
@click.option("--json", "to_json", is_flag=True, help="Print the numbers; draw only with -o.")
@largest_file_option
@pass_messages
def campbell(messages: Messages, scene: str, output: Path | None, to_json: bool, largest_file: int) -> None:
    """Draw the natural frequencies of SCENE, a sector of a ring, by nodal diameter (SAFE diagram).

    Drawn are those with its contacts open and stuck. Bars show the range of frequencies at the engine order
    and its harmonics. Lines show all engine orders at the lowest (dotted) and highest (dashed) speed.
    Without [response] there are neither.
    Of a mistuned ring it is that of the tuned one.
    """
    from fcm.scene import SceneError, load_scene

    loaded = load_scene(scene, largest_file=largest_file, solved=False)
    loaded = (loaded if loaded.tuned is None else loaded.tuned).in_use()
    if loaded.ring is None:
        raise SceneError(
            scene, ["has no [cyclic]: this diagram is of a ring of sectors; fcm plot modes lists the modes"]
        )
    found = numbers(loaded)
    if to_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    for note in loaded.notes:
        messages.note(note)
    if not to_json or output is not None:
        output = picture_of(Path(scene), output, "-campbell.png", *loaded.files)
        save_picture(_picture(found), output)
        messages.info(wrote(output))


def numbers(scene: Scene) -> dict[str, Any]:
    """The diagram in numbers, frequencies in the scene's unit."""
    from fcm.structure.ring import nodal_diameters
    from fcm.units import in_unit

    ring, unit = scene.ring, scene.frequency_unit
    assert ring is not None
    orders = {one.ring.engine_order: one.ring for one in scene.each_curve() if one.ring is not None}
    span = in_unit(scene.frequency_range, unit).tolist() if scene.has_range else None
    diameters = [
        {
            "nodal_diameter": one.number,
            "open": in_unit(one.opened, unit).tolist(),
            "stuck": in_unit(one.stuck, unit).tolist(),
        }
        for one in nodal_diameters(scene)
    ]
    return {
        "scene": scene.name,
        "title": scene.title,
        "frequency_unit": unit,
        "sectors": ring.sectors,
        "range": span,
        "engine_orders": [
            {
                "engine_order": order,
                "speeds": [end / abs(order) for end in span] if order and span else None,
                "nodal_diameters": [of_order.meets(h) for h in range(SENTENCES.harmonics + 1)],
                "resonances": _resonances(diameters, of_order.meets(1), span),
            }
            for order, of_order in orders.items()
        ],
        "diameters": diameters,
    }


def _resonances(
    diameters: list[dict[str, Any]], number: int, span: list[float] | None
) -> dict[str, list[float]] | None:
    """Natural frequencies of one diameter within the range, if there is one."""
    if span is None:
        return None
    met = [one for one in diameters if one["nodal_diameter"] == number]
    low, high = span
    return {k: [f for one in met for f in one[k] if low <= f <= high] for k in ("open", "stuck")}


def _picture(found: dict[str, Any]) -> Any:
    import numpy as np

    from fcm.plot.campbell import DrawnRing, draw_campbell

    diameters = found["diameters"]
    opened, stuck = (tuple(np.array(one[state]) for one in diameters) for state in ("open", "stuck"))
    return draw_campbell(
        DrawnRing(
            title=found["title"],
            sectors=found["sectors"],
            engine_orders=tuple(one["engine_order"] for one in found["engine_orders"]),
            span=None if found["range"] is None else (found["range"][0], found["range"][1]),
            unit=found["frequency_unit"],
            diameters=tuple(one["nodal_diameter"] for one in diameters),
            opened=opened,
            stuck=stuck,
        )
    )
