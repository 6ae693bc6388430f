"""Figures, tables, sentences and pages of results; nothing is simulated or decided here.

report_data  all results that figures and reports can show
charts       data of the ladder and of the conditions of error, for paper and screen
figures      the figures, one a file
tables       tables as CSV and LaTeX
words        says in sentences what numbers mean
wording      names and numbers as people write them
units        units as people print them
formula      equations as MathML
html         the report as one HTML file
pages        writes results into pages of docs/
catalogue    the page of the catalogue of effects
"""
