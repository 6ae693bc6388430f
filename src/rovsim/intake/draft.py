"""A proposal in the making: content, comments and questions by place."""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from rovsim.intake.proposal import ANSWER, Question


@dataclass
class Draft:
    """What has been put together so far."""

    content: dict[str, Any] = field(default_factory=dict)
    comments: dict[str, list[str]] = field(default_factory=dict)
    questions: list[Question] = field(default_factory=list)

    def say(self, place: str, *lines: str) -> None:
        """Comments above the line of a place."""
        if any(lines):
            self.comments.setdefault(place, []).extend(line for line in lines if line)

    def ask(
        self, place: str, asks: str, answers: Sequence[str] | Mapping[str, str], free: bool = False
    ) -> str:
        """Ask for a value; returns what stands there until somebody answers."""
        meant = answers if isinstance(answers, Mapping) else dict.fromkeys(answers, "")
        self.questions.append(Question(place, asks, tuple(meant.items()), free))
        return ANSWER
