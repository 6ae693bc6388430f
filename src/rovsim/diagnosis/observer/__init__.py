"""A model that runs along a measurement, corrected by a filter: what it could not foresee."""
