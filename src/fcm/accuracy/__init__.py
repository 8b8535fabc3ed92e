"""Error of a harmonic-balance curve by its embedded pair, and as many harmonics as an accuracy needs."""
