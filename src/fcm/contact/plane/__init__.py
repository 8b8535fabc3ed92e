"""A contact that slides in a plane, over any periodic motion: kernels, and what Python calls."""
