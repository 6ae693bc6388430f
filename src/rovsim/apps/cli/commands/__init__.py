"""The commands, one module each: a docstring for --help, `Settings`, `run(settings, catalogue)`.

`Settings` names the parts of the configuration that the command takes; it sees no other.
"""
