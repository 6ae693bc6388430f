"""The project's own benchmark: hide physics in the tank, ask what is missing, keep the score."""
