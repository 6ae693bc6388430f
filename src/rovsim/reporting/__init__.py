"""What is shown. Decides nothing, computes no physics.

report_data  what figures and reports show
charts       the ladder and the conditions of error, for paper and screen
figures      the figures, one a file
tables       tables as CSV and LaTeX
words        what numbers say, in sentences
wording      names and numbers as people write them
units        units as people print them
formula      equations as MathML
html         the report
pages        pages of docs/ with results in them
catalogue    the catalogue page
"""
