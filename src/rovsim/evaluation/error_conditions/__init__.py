"""Where a model fails: its error by axis and condition, and what that says in plain language.

conditions  the conditions that the vehicle was in, and the error there
bins        errors in bins of a condition, compared with chance
findings    finds the condition that explains most of the error, then the next
search      searches all runs of a campaign
lowered     how a change of the model changes its error over a condition
entries     the findings as `where.json` has them
sentences   the findings in sentences
"""
