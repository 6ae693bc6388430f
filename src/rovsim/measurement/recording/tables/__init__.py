"""Text in columns: what readers of csv and tsv files have in common.

delimited      names, separators, lines
cells          cells of text: a number, or "not measured"
numbers        whole columns of numbers
named_columns  columns by their names, and errors where one is missing
units          units of columns, behind their names or in a line below
times          a column of times
dates          times that are dates
"""
