"""TODO held_out."""
