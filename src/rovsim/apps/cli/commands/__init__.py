"""The commands: one module each, with a docstring for --help and a function `run(settings)`."""
