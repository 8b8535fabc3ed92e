"""Matrices as finite-element programs write them: one module for each format."""
