"""The comparison with another package needs that package, which the tests do not have."""

collect_ignore = ["pyharm.py"]
