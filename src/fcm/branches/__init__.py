"""Every branch of a response: from the level of the forces, from its folds, and from branch points."""
