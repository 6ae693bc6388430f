"""TODO dynamics."""
