"""What a command says when it is done: words, JSON, or nothing."""

import json
from typing import Any

from rovsim.application.settings import Settings


def say(settings: Settings, text: str, content: Any) -> None:
    """Print the text, its content as JSON with `output=json`, nothing with `output=quiet`."""
    if settings.output == "json":
        print(json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False))
    elif settings.output == "text":
        print(text)
