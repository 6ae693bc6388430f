"""The report: one HTML file that needs nothing else, of a study or of a command's results.

picture  figures inside the page
report   the page
folder   a command's figures and its page
kept     pages that were in that folder before
"""
