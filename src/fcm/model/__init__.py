"""What a checked scene is: its structure, contacts and forces, the ring it may be a sector of, its curves."""
