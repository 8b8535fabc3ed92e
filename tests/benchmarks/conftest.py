"""The comparisons with other packages need those packages, which the tests do not have."""

import sys
from pathlib import Path

collect_ignore_glob = ["others/with_*.py"]
sys.path.append(str(Path(__file__).parent))  # as of programs that are run from here
