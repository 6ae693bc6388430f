"""The compiled equation of motion."""
