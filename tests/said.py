"""What a command said, as one line: messages are folded for a terminal."""


def unfolded(text: str) -> str:
    """The same words, with single spaces between them."""
    return " ".join(text.split())
