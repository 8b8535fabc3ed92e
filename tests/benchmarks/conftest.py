"""The comparisons with other packages need those packages, which the tests do not have."""

collect_ignore_glob = ["others/with_*.py"]
