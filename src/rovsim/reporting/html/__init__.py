"""The report: one HTML file that needs nothing else, of a study or of a command's results."""
