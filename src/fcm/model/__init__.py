"""The checked scene: structure, contacts, forces, ring and curves."""
