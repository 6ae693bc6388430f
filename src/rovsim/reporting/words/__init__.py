"""What numbers say, in plain language: one statement for terminal, report, workbench and notebook.

verdict           says what a diagnosis found
apart             says what these runs cannot tell apart
sureness          how sure a name is, and why no probability is given where none is
sentences         the report's summary
speed             what the timing says about control loops
published_errors  says how folds compare with published errors, and what pitfalls cost
experiment        says what a designed flight promises
shown             says what recordings could not show
totals            a coefficient of the vehicle file with what a diagnosis adds to it
symbols           what the letters of an equation stand for
terminal          what `compare` and `diagnose` print when they are done
"""
