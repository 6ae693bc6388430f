"""The command `rovsim`: one command a file in `commands`.

main        the entry point: one message and exit code 2 for input that cannot be used
complaint   prints such a message
untaken     refuses keys that a command does not use
dispatch    from composed settings to a command
commands    the commands
opening     opens the campaign of a command, and finds where it writes
output      prints results, as text or JSON
sweep       a Hydra multirun, and one job of it
unfinished  a run of a sweep, unless it is finished
completion  what the shell offers for the Tab key
"""
