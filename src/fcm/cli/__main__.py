"""``python -m fcm.cli``: the program where no script ``fcm`` is installed."""

from fcm.cli import main

main(prog_name="fcm")
