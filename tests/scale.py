"""How hard to look: FCM_TEST_SCALE=20 in the environment makes twenty times as many random cases as usual.

A usual run has the same cases every time, so that a change fails for what it changes.
"""

import os

SCALE = float(os.environ.get("FCM_TEST_SCALE", "1"))
