"""``python -m fcm``: the program, as ``fcm``."""

from fcm.cli.__main__ import run

if __name__ == "__main__":
    run()
