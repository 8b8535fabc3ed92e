"""Pages that show results beside what was expected of them, from result files by ``make``; a measurement."""
