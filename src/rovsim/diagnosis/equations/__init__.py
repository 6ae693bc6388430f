"""An equation for what no effect of the catalogue explains, or the force in time where none is."""
