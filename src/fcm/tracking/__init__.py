"""Continuation of peaks, folds and onsets of a response in a number of its scene, and the least peak."""
