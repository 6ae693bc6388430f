"""How fast replay and inference are here, beside the libraries: one honest run, machines differ."""
