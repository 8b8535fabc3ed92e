"""Kernels: the forces of a contact over any periodic motion, exactly; from the motion's polynomials upwards."""
