"""Tell what a proposed campaign.yaml says, and which of it is a guess, as lines to be shown."""

from types import MappingProxyType
from typing import Any, Iterator, Mapping

from rovsim.intake.proposal import ANSWER, CampaignProposal
from rovsim.intake.sections import AXES_MEANINGS, KIND_MEANINGS
from rovsim.reporting.wording import listed

GUESS_PREFIX = "guess: "


def list_taken(proposal: CampaignProposal) -> list[str]:
    """List vehicle, axes and commands with what their words mean; without what is still asked."""
    return [f"{name}: {meaning}" for name, meaning in _taken(proposal.content) if meaning]


def _taken(content: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    mocap, commands = content.get("mocap", {}), content.get("commands", {})
    yield "vehicle", _answered(content, "vehicle")
    yield "axes of the world", _meant(_answered(mocap, "world_axes"), AXES_MEANINGS)
    yield "axes of the body", _meant(_answered(mocap, "body_axes"), AXES_MEANINGS)
    yield "commands", _meant(_answered(commands, "kind"), KIND_MEANINGS)
    columns, axes = commands.get("columns", []), commands.get("axes", [])
    if isinstance(columns, list) and columns:
        pairs = [f"{c} ({a})" for c, a in zip(columns, axes, strict=False)] or columns
        yield "columns of commands", ", ".join(pairs)


def _answered(section: Mapping[str, Any], key: str) -> str:
    value = section.get(key, ANSWER)
    return "" if value == ANSWER else str(value)


def _meant(word: str, meanings: Mapping[str, str]) -> str:
    return f"{word}, {meanings[word]}" if word in meanings else word


def list_guesses(
    proposal: CampaignProposal, topics: Mapping[str, str] = MappingProxyType({})
) -> list[str]:
    """List the guesses and their reasons: first of the campaign, then of runs.

    Runs with the same reason share a line.

    Args:
        proposal: whose comments mark the guesses.
        topics: what a place is called in a line, where not by its key.
    """
    guesses: list[str] = []
    runs: dict[str, list[str]] = {}  # ids of the runs that have a reason
    for place, lines in proposal.comments.items():
        for line in lines:
            reason = line.removeprefix(GUESS_PREFIX)
            if line == reason:
                continue
            if place.startswith("runs."):
                runs.setdefault(reason, []).append(_run(proposal, place))
            else:
                guesses.append(f"{topics.get(place, place)}: {_value(proposal, place)}{reason}")
    for reason, names in runs.items():
        guesses.append(f"Run{'s' if len(names) > 1 else ''} {listed(names)}: {reason}")
    return guesses


def _run(proposal: CampaignProposal, place: str) -> str:
    """Return the id of the run to which a place belongs."""
    return _find(proposal, ".".join(place.split(".")[:2]))["id"]


def _find(proposal: CampaignProposal, place: str) -> Any:
    """Return what the proposed campaign.yaml holds at a place."""
    value: Any = proposal.content
    for part in place.split("."):
        value = value[int(part)] if isinstance(value, list) else value[part]
    return value


def _value(proposal: CampaignProposal, place: str) -> str:
    value = _find(proposal, place)
    is_list = isinstance(value, list) and value and isinstance(value[0], str)
    text = ", ".join(value) if is_list else value
    return f"{text}; " if isinstance(text, str) else ""
