"""Nonlinear modes: the extended periodic motion, backbones, response near a resonance."""
