"""A proposal in the making: content, comments and questions of a campaign.yaml.

A place is the dotted path of a key, such as `mocap.body` or `runs.0`.
"""

from dataclasses import dataclass, field
from typing import Any, Mapping, Sequence

from rovsim.intake.proposal import ANSWER, OpenQuestion


@dataclass
class CampaignDraft:
    """What has been put together so far.

    Attributes:
        content: of campaign.yaml, by key.
        comments: lines above a key, by its place.
        questions: that a person has to answer.
    """

    content: dict[str, Any] = field(default_factory=dict)
    comments: dict[str, list[str]] = field(default_factory=dict)
    questions: list[OpenQuestion] = field(default_factory=list)

    def comment(self, place: str, *lines: str) -> None:
        """Add comment lines above the key of a place; empty ones are dropped."""
        if any(lines):
            self.comments.setdefault(place, []).extend(line for line in lines if line)

    def ask(
        self, place: str, asks: str, answers: Sequence[str] | Mapping[str, str], free: bool = False
    ) -> str:
        """Add a question.

        Args:
            place: of the key that the answer is the value of.
            asks: the question.
            answers: to choose from, as a mapping with what each means.
            free: whether other answers are possible as well.

        Returns:
            The value that stands there until somebody answers.
        """
        meanings = answers if isinstance(answers, Mapping) else dict.fromkeys(answers, "")
        self.questions.append(OpenQuestion(place, asks, tuple(meanings.items()), free))
        return ANSWER
