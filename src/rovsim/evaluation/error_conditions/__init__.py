"""Where a model fails: its error by axis and condition, and what that says in plain language.

conditions  in what condition the vehicle was, and what the model missed there
bins        errors by bins of a condition, against chance
findings    which condition explains the error, one after the other
search      the runs of a campaign, searched
lowered     what a change of the model does to its error, over a condition
entries     what was found, as `where.json` holds it
sentences   and as sentences
"""
