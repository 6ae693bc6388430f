"""What numbers say, in plain language: one statement for terminal, report, workbench and notebook.

verdict           what a diagnosis found
apart             what these runs cannot tell apart
sureness          how sure a name is, and why no probability is given where none is
sentences         the report's summary
speed             what the timing says about control loops
published_errors  folds beside published errors, pitfalls
experiment        what a designed flight promises
shown             what recordings could not show
totals            what a coefficient of the vehicle file comes to with what was added
symbols           what the letters of an equation stand for
terminal          what `compare` and `diagnose` say when they are done
"""
