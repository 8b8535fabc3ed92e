"""Numbers that the pages of validation claim and a run tells."""

import json
import re

from ..program import called
from .pages import PAGES, read


def test_the_table_errs_by_far_less_than_the_harmonics_left_out():
    (claim,) = re.findall(r"moves no point by\s+more\s+than\s+(\S+)\s+of", "\n".join(map(read, PAGES)))
    curves = json.loads(called("respond", "yang1998", "--json").out)["curves"]
    table, harmonic = (max(curve[name] for curve in curves) for name in ("table_error", "truncation_error"))
    assert 0 < table < float(claim) and harmonic > 100 * table  # "by far the larger error"
