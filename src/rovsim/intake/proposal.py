"""What is known of a campaign before its owner has said a word, and what has to be asked."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Mapping

from rovsim.core.errors import BadInput
from rovsim.measurement.unanswered import ANSWER


@dataclass(frozen=True)
class Question:
    """A key that only a person can fill in: its place, the question, answers and what they mean.

    `free`: other answers are possible as well.
    """

    place: str
    asks: str
    answers: tuple[tuple[str, str], ...]
    free: bool = False


@dataclass(frozen=True)
class CampaignProposal:
    """The content of campaign.yaml with `ANSWER` where something is asked.

    `comments` by place (`mocap.body`, `runs.0`); `found` are lines about the files, `checks` what
    looks wrong in them; `copies` are files to be written beside campaign.yaml, by where they are
    now.
    """

    content: Mapping[str, Any]
    comments: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    questions: tuple[Question, ...] = ()
    found: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()
    copies: Mapping[Path, str] = field(default_factory=dict)

    def fully(self, answers: Mapping[str, str]) -> "CampaignProposal":
        """The proposal with an answer to every question.

        Raises:
            BadInput: one is missing, or not among the choices.
        """
        found = self.answered(answers)
        for question in found.questions:
            raise _ask_for(question)
        return found

    def answered(self, answers: Mapping[str, str]) -> "CampaignProposal":
        """The proposal with answers by place; those that are empty stay open.

        Raises:
            BadInput: an answer that is not among the choices.
        """
        content, left = _copied(self.content), []
        for question in self.questions:
            answer = answers.get(question.place, "").strip()
            if not answer:
                left.append(question)
                continue
            _check(question, answer)
            _put(content, question.place.split("."), answer)
        return replace(self, content=content, questions=tuple(left))


def _ask_for(question: Question) -> BadInput:
    return BadInput(
        "no answer",
        where=question.place,
        expected=f"one of {', '.join(value for value, _ in question.answers)}",
        remedy="Answer every question; the recordings do not tell.",
    )


def _check(question: Question, answer: str) -> None:
    known = [value for value, _ in question.answers]
    if not question.free and answer not in known:
        raise BadInput(
            f"'{answer}'",
            where=question.place,
            expected=f"one of {', '.join(known)}",
            remedy="Choose one of them.",
        )


def _put(content: Any, place: list[str], answer: str) -> None:
    for part in place[:-1]:
        content = content[int(part)] if isinstance(content, list) else content[part]
    content[place[-1]] = _listed(answer)


def _listed(answer: str) -> str | list[str]:
    """A list where the answer is written as one: [t1, t2]."""
    if not (answer.startswith("[") and answer.endswith("]")):
        return answer
    return [part.strip() for part in answer[1:-1].split(",") if part.strip()]


def _copied(content: Any) -> Any:
    if isinstance(content, Mapping):
        return {key: _copied(value) for key, value in content.items()}
    return [_copied(value) for value in content] if isinstance(content, list) else content


__all__ = ["ANSWER", "CampaignProposal", "Question"]
