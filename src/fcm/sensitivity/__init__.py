"""Derivatives of the peaks of a response by the numbers of its scene."""
