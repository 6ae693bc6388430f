"""Pages of docs/ with results in them; the words around these are written by hand.

marked             tables between two marks
against_published  folds beside published errors
leave_one_run_out  those of docs/thesis.md
"""
