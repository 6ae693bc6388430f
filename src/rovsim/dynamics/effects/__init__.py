"""The effects of the catalogue, one family a file, and what every effect is."""
