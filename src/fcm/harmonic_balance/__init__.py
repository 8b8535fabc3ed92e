"""Response curves by harmonic balance."""
