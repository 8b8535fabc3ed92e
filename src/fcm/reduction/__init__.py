"""Leaves out what a scene does not need, restores it in the results, and checks the effect."""
