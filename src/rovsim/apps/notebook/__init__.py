"""rovsim in a notebook: a campaign that is opened, and results that show themselves.

campaign   an open campaign: compare, diagnose, add, train, export
shown      what these return: the pipeline's results with tables, figures and HTML
html       how they look in a notebook
progress   how far long work is, in a cell
"""

from rovsim.apps.notebook.campaign import Campaign, open, tank

__all__ = ["Campaign", "open", "tank"]
