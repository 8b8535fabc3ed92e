"""The linear structure: from its matrices to modes, and the flexibility of the modes left out."""
