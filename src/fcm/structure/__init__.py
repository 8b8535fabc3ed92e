"""The linear structure: from its matrices to modes, and to the flexibility of those that are left out."""
