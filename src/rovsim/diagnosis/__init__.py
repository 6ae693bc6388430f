"""Which physical effect is missing: observe, search, check, say (see diagnose.py)."""
