"""The forces of a contact over any periodic motion, exactly: kernels, and what Python calls."""
