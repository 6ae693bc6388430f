"""The effects of the catalogue, one family a file; `base` says what every effect is."""
