"""Stability of periodic motions, balanced or exact: monodromy, Floquet multipliers, bifurcations.

A `StateSequence` represents a motion: it lists the changes of the contacts' states over a period. The
`Monodromy` follows from it, and its eigenvalues are the Floquet multipliers. A bifurcation is a point of a
branch at which multipliers leave the unit circle.
"""
