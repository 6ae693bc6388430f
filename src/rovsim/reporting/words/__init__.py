"""Say in sentences what results mean; terminal, report, workbench and notebook share them.

verdict           says what a diagnosis found
apart             says what the runs cannot tell apart
sureness          says how sure an effect's name is, and why some have no probability
sentences         the report's summary
speed             says what control loops predictors are fast enough for
published_errors  says how folds compare with published errors, and what pitfalls cost
experiment        says what a designed flight promises
shown             says what recordings could not show
totals            sums of coefficients of the vehicle file and of a diagnosis
intervals         fitted values with their 95 % intervals
unexplained       says what no effect explains: a law for it, or the force in time
symbols           explains the symbols of an equation
terminal          what `compare`, `train` and `diagnose` print when they are done
"""
