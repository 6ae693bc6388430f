"""Which effects are missing: candidates, fits, search, and what is held out from it."""
