"""The commands: one module each, its docstring for --help, and `run(settings, catalogue)`."""
