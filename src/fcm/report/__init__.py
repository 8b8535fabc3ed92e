"""Pages that show results beside what was expected of them, made from result files by ``make``."""
