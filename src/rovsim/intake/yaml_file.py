"""Format a proposal as the text of a commented campaign.yaml."""

import io
import textwrap
from typing import Any, Mapping

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq

from rovsim.intake.proposal import CampaignProposal, OpenQuestion

MAX_LINE_WIDTH = 110
HEADER = (
    "Written by `rovsim init` from what stands in the recordings. Values without a comment were "
    "found there; 'guess' marks what may be otherwise, and says why it was taken. docs/formats.md "
    "explains the keys."
)


def as_yaml(proposal: CampaignProposal) -> str:
    """Return the text of campaign.yaml; each question is a comment above the key it is about."""
    document = CommentedMap()
    for key, value in proposal.content.items():
        document[key] = _node(value, flow=False)
    comments = {place: [*lines] for place, lines in proposal.comments.items()}
    for question in proposal.questions:
        comments.setdefault(question.place, []).extend(_asked(question))
    for place, lines in comments.items():
        _write(document, place.split("."), lines)
    document.yaml_set_start_comment(_wrapped([HEADER, *_open(proposal)], MAX_LINE_WIDTH))
    yaml, text = YAML(), io.StringIO()
    yaml.width, yaml.allow_unicode = 1 << 16, True
    yaml.indent(mapping=2, sequence=4, offset=2)
    yaml.dump(document, text)
    return text.getvalue()


def _open(proposal: CampaignProposal) -> list[str]:
    count = len(proposal.questions)
    summary = f"{count} line{'s' * (count > 1)} to be answered: look for ANSWER." if count else ""
    return [*([summary] if summary else []), *(f"CHECK: {check}" for check in proposal.checks)]


def _asked(question: OpenQuestion) -> list[str]:
    choices = "; ".join(f"{v} ({meaning})" if meaning else v for v, meaning in question.answers)
    suffix = " or another" if question.free else ""
    return [f"ANSWER: {question.asks} {choices}{suffix}".rstrip()]


def _node(value: Any, flow: bool) -> Any:
    """Convert plain content to YAML nodes, which can carry comments.

    Args:
        value: mapping, list or scalar.
        flow: whether it is written on one line. A list of scalars, and a mapping in a list, are
            always written on one line.
    """
    node: CommentedMap | CommentedSeq
    if isinstance(value, Mapping):
        node = CommentedMap((key, _node(inner, flow)) for key, inner in value.items())
    elif isinstance(value, list):
        inner_flow = any(isinstance(inner, Mapping) for inner in value)
        node = CommentedSeq(_node(inner, inner_flow or flow) for inner in value)
        flow = flow or not inner_flow
    else:
        return value
    if flow:
        node.fa.set_flow_style()
    return node


def _write(document: CommentedMap, place: list[str], lines: list[str]) -> None:
    """Put a comment above the key of a place; above the whole entry where that is in a list."""
    node: Any = document
    depth = 0
    for part in place[:-1]:
        inner = node[int(part)] if isinstance(node, CommentedSeq) else node[part]
        if isinstance(node, CommentedSeq):
            return _above(node, int(part), lines, depth)
        node, depth = inner, depth + 2
    key: Any = place[-1]
    return _above(node, int(key) if isinstance(node, CommentedSeq) else key, lines, depth)


def _above(node: Any, key: Any, lines: list[str], depth: int) -> None:
    existing = node.ca.items.get(key)
    comments = [*_texts(existing), _wrapped(lines, MAX_LINE_WIDTH - depth)]
    node.yaml_set_comment_before_after_key(key, before="\n".join(comments), indent=depth)


def _texts(old: Any) -> list[str]:
    """Take the comments above a key away and return them, to be set again with new ones."""
    tokens = (old[1] or []) if old and len(old) > 1 else []
    texts = [token.value.strip().removeprefix("# ").removeprefix("#") for token in tokens]
    if old and len(old) > 1:
        old[1] = None
    return texts


def _wrapped(lines: list[str], width: int) -> str:
    filled = [
        textwrap.wrap(line, width - 2, break_long_words=False, break_on_hyphens=False) or [""]
        for line in lines
    ]
    return "\n".join(part for parts in filled for part in parts)
