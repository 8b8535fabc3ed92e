"""Numbers of a scene fitted to measured curves, by least squares with exact derivatives."""
