"""The command `rovsim`: one command a file in `commands`.

main        one message and exit code 2 for input that cannot be used
complaint   that message
untaken     keys that a command has no use for
dispatch    from composed settings to a command
commands    the commands
opening     the campaign of a command, and where it writes
output      what it says, and where it may write
sweep       a Hydra multirun, and one job of it
completion  what the shell's Tab key asks
"""
