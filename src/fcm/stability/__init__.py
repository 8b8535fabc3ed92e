"""Stability of periodic motions, balanced or exact: monodromy, Floquet multipliers, bifurcations.

A motion is known here by its `StateSequence`: which contact changes its state when, and into which. From one
the `Monodromy` follows; its eigenvalues are the multipliers; where these leave the unit circle along a branch
is a bifurcation.
"""
