"""Write results into pages of docs/, whose other text is written by hand.

marked             replaces tables between two marks
against_published  tables of folds beside published errors
leave_one_run_out  the tables of docs/thesis.md
"""
