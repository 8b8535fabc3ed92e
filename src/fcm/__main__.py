"""``python -m fcm`` runs the program like the command ``fcm``."""

from fcm.cli.__main__ import run

if __name__ == "__main__":
    run()
