"""Synthetic campaigns, written as raw exports with the truth sealed beside them."""
