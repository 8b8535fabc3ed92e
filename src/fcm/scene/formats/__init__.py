"""Readers of matrices written by finite-element programs: one module for each format."""
