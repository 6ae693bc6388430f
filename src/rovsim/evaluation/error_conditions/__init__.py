"""Where a model fails: its error by axis and condition, and what that says in plain language."""

from rovsim.evaluation.error_conditions.conditions import Blocks, blocks, together
from rovsim.evaluation.error_conditions.content import content, merged
from rovsim.evaluation.error_conditions.findings import Finding, Where, explain
from rovsim.evaluation.error_conditions.search import Judged, judged

__all__ = [
    "Blocks", "Finding", "Judged", "Where", "blocks", "content", "explain", "judged", "merged",
    "together",
]  # fmt: skip
