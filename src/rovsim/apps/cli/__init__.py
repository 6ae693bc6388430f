"""The command `rovsim`: one command a file in `commands`."""
