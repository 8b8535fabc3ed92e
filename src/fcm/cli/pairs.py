"""``fcm plot pairs SCENE``: which nodes of two sets are pairs, before anything is solved."""

from __future__ import annotations

from pathlib import Path

import click

from fcm.cli.drawing import ENDINGS, picture_of, save_picture_of
from fcm.cli.files import largest_file_option, output_option, wrote
from fcm.cli.messages import Messages, pass_messages
from fcm.cli.options import scene_argument


@click.command()
@scene_argument
@output_option(
    "-o", "--output", endings=ENDINGS,
    help="The picture to write: .png, .svg or .pdf.  [default: SCENE with the ending -pairs.png]",
)  # fmt: skip
@click.option(
    "--contact", multiple=True, metavar="NAME", help="Of this contact; again for more.  [default: all]"
)
@largest_file_option
@pass_messages
def pairs(
    messages: Messages, scene: str, output: Path | None, contact: tuple[str, ...], largest_file: int
) -> None:
    """Draw the pairs of nodes of SCENE, seen along the normal of each contact.

    Partners are joined by lines, coloured by how far apart they are; nodes without a partner are crosses.
    """
    from fcm.plot.pairs import draw_pairs
    from fcm.scene.load_pairs import load_pairs

    loaded = load_pairs(scene, largest_file=largest_file)
    known = [one.name for one in loaded.interfaces]
    for name in contact:
        if name not in known:
            there = ", ".join(known) or "none"
            raise click.UsageError(
                f"--contact {name}: no contact of that name has pairs with places; there are {there}."
            )
    chosen = [one for one in loaded.interfaces if not contact or one.name in contact]
    output = picture_of(Path(scene), output, "-pairs.png", *loaded.files)
    for note in loaded.notes:
        messages.note(note)
    save_picture_of(lambda: draw_pairs(chosen, loaded.length), output)
    messages.info(wrote(output))
