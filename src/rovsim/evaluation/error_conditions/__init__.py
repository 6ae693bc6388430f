"""Where a model fails: its error by axis and condition, and what that says in plain language."""
