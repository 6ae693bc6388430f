"""What the names and types of topics tell."""

import re

# Topics that say where the vehicle should be, or where something else is: never read.
GOALS = re.compile(r"goal|waypoint|setpoint|initialpose|target|desired|landing|mission|gp_", re.I)


def short_type(kind: str) -> str:
    """Return the name of a message type without its package."""
    return kind.rsplit("/", 1)[-1]


def tell_of_unread(topics: dict[str, str], named: str, kind: str, sentence: str) -> str:
    """Make a sentence on topics that rovsim does not read; empty where there are none.

    Args:
        topics: message type by topic.
        named: regex that is searched for in a topic's name.
        kind: regex of the whole short message type.
        sentence: the sentence, with {} for the topics.
    """
    matches = [
        topic
        for topic, name in topics.items()
        if re.search(named, topic, re.I) and re.fullmatch(kind, short_type(name))
    ]
    return sentence.format(", ".join(matches)) if matches else ""
