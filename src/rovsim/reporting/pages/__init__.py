"""Pages of docs/ with results in them; the words around these are written by hand.

marked             replaces tables between two marks
against_published  tables of folds beside published errors
leave_one_run_out  the tables of docs/thesis.md
"""
