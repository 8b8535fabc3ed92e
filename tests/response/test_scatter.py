"""Percentiles over random draws: of peaks, of their frequencies, and of jumps; bands of the response."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray

import fcm
from fcm.plot.read import DrawnCurve, read_response
from fcm.response.sweep import trace
from fcm.results.bands import bands_of, greatest_at
