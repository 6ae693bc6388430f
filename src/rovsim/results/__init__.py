"""Results as they are written and read: one frozen model for each JSON file."""
