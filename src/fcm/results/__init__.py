"""Curves, histories and tracked points as data: summaries, datasets, netCDF, CSV and JSON."""
