"""The command `rovsim`: one command a file in `commands`.

main        one message and exit code 2 for input that cannot be used
complaint   that message
untaken     keys that a command has no use for
dispatch    from composed settings to a command
commands    the commands
output      where a command writes, and what it says
sweep       one job of a Hydra multirun
completion  what the shell's Tab key asks
"""
