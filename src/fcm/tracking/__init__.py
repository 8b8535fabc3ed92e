"""Peaks, folds and onsets of a response as curves in a number of its scene, and the least peak."""
