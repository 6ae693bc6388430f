"""What the names of files say: runs, and which files belong together."""

import re
from typing import Sequence

from rovsim.core.names import is_name

# Words that say what a file is and not which run.
ROLES = (
    "6d|6dof_?export|poses?|mocap|motion|track(ing)?|qtm|qualisys|motive|optitrack|take|vicon|export|"
    "commands?|cmds?|pwms?|rc|rcout|thrusters?|thrust|servos?|inputs?|control_?inputs?|actuation|"
    "setpoints?|log|data|raw"
)
WORD = re.compile(rf"(^|[_\-\s.]+)({ROLES})(?=$|[_\-\s.]+)", re.IGNORECASE)


def run_key(stem: str) -> str:
    """What is left of a file's stem without the words that say what it is."""
    return re.sub(r"[\s_\-.]+", "-", _without_role(stem)).strip("-").casefold()


def run_ids(stems: Sequence[str]) -> list[str]:
    """A name for each run: the stem without its role and a leading `run`; all different."""
    for make in (_short, lambda stem: _without_role(stem) or stem, lambda stem: stem):
        ids = [_safe(make(stem)) for stem in stems]
        if all(ids) and len({i.casefold() for i in ids}) == len(ids):
            return ids
    return [f"run-{k}" for k in range(1, len(stems) + 1)]


def _without_role(stem: str) -> str:
    left = stem
    while (shorter := WORD.sub("", left)) != left:
        left = shorter
    return left.strip(" _-.")


def _short(stem: str) -> str:
    return re.sub(r"^run[_\-\s]*(?=.)", "", _without_role(stem), flags=re.IGNORECASE)


def _safe(name: str) -> str:
    """A name that can be part of a file name (as campaign.yaml demands)."""
    whole = "".join(c if is_name(c) else "-" for c in name)
    return re.sub(r'[/\\:*?"<>|{}]', "-", whole).strip().lstrip(".-~ ")[:80].strip()


def campaign_name(folder: str) -> str:
    """A name for the campaign in that folder."""
    return _safe(folder) or "campaign"


def said_control(name: str) -> str | None:
    """`3dof` or `6dof` where a name says so."""
    said = {word.lower() for word in re.findall(r"[36]dof", name, re.IGNORECASE)}
    return said.pop() if len(said) == 1 else None
