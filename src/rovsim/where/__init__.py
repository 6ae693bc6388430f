"""Where a model fails: its error by axis and condition, and what that says in plain language."""

from rovsim.where.conditions import Blocks, blocks, together
from rovsim.where.content import content, merged
from rovsim.where.findings import Finding, Where, explain
from rovsim.where.search import Judged, judged

__all__ = [
    "Blocks", "Finding", "Judged", "Where", "blocks", "content", "explain", "judged", "merged",
    "together",
]  # fmt: skip
