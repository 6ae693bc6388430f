"""A proposed campaign.yaml: what the recordings tell, and questions that a person must answer."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Mapping

from rovsim.core.errors import BadInput
from rovsim.measurement.unanswered import ANSWER


@dataclass(frozen=True)
class OpenQuestion:
    """A key whose value only a person can give.

    Attributes:
        place: dotted path of the key, such as `mocap.body`.
        asks: the question.
        answers: to choose from, each with what it means (may be empty).
        free: whether other answers are possible as well.
    """

    place: str
    asks: str
    answers: tuple[tuple[str, str], ...]
    free: bool = False


@dataclass(frozen=True)
class CampaignProposal:
    """A campaign.yaml that is not yet written.

    Attributes:
        content: by key, with `ANSWER` where something is asked.
        comments: lines above a key, by its place (`mocap.body`, `runs.0`).
        questions: that are still open.
        findings: lines about the files.
        checks: lines about what looks wrong in the files.
        copies: files to be copied, and the path of each copy beside campaign.yaml.
    """

    content: Mapping[str, Any]
    comments: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    questions: tuple[OpenQuestion, ...] = ()
    findings: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()
    copies: Mapping[Path, str] = field(default_factory=dict)

    def fully(self, answers: Mapping[str, str]) -> "CampaignProposal":
        """Return the proposal with an answer to every question.

        Args:
            answers: by place.

        Raises:
            BadInput: an answer is missing, or not among the choices.
        """
        proposal = self.answered(answers)
        for question in proposal.questions:
            raise _ask_for(question)
        return proposal

    def answered(self, answers: Mapping[str, str]) -> "CampaignProposal":
        """Return the proposal with some answers; questions without one stay open.

        Args:
            answers: by place; an empty one counts as none.

        Raises:
            BadInput: an answer is not among the choices.
        """
        content, unanswered = _copied(self.content), []
        for question in self.questions:
            answer = answers.get(question.place, "").strip()
            if not answer:
                unanswered.append(question)
                continue
            _check(question, answer)
            _put(content, question.place.split("."), answer)
        return replace(self, content=content, questions=tuple(unanswered))


def _ask_for(question: OpenQuestion) -> BadInput:
    return BadInput(
        "no answer",
        where=question.place,
        expected=f"one of {', '.join(value for value, _ in question.answers)}",
        remedy="Answer every question; the recordings do not tell.",
    )


def _check(question: OpenQuestion, answer: str) -> None:
    choices = [value for value, _ in question.answers]
    if not question.free and answer not in choices:
        raise BadInput(
            f"'{answer}'",
            where=question.place,
            expected=f"one of {', '.join(choices)}",
            remedy="Choose one of them.",
        )


def _put(content: Any, place: list[str], answer: str) -> None:
    for part in place[:-1]:
        content = content[int(part)] if isinstance(content, list) else content[part]
    content[place[-1]] = _listed(answer)


def _listed(answer: str) -> str | list[str]:
    """Parse an answer that is written as a list, such as [t1, t2]; return others as they are."""
    if not (answer.startswith("[") and answer.endswith("]")):
        return answer
    return [part.strip() for part in answer[1:-1].split(",") if part.strip()]


def _copied(content: Any) -> Any:
    if isinstance(content, Mapping):
        return {key: _copied(value) for key, value in content.items()}
    return [_copied(value) for value in content] if isinstance(content, list) else content


__all__ = ["ANSWER", "CampaignProposal", "OpenQuestion"]
