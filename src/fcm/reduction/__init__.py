"""Omits parts that a scene does not need, restores them in the results, and checks the effect."""
