"""What every room needs and what needs nothing: errors, files, rotations, progress, runs."""
