"""What a scene does not need: left out, put back into the results, its effect checked."""
