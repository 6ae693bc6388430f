"""Pages of the documentation, as tests read them."""

import re


def fenced(page: str, kind: str) -> list[str]:
    """Fenced blocks of a page, of one kind: `sh`, `python`, `yaml`."""
    return re.findall(rf"```{kind}\n(.*?)```", page, re.DOTALL)
