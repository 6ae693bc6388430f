"""The report: one HTML file that needs nothing else, of a study or of a command's results.

picture  figures inside the page
report   the page itself
folder   writes the figures and the page of a command into a folder
kept     pages that were in the folder before
"""
