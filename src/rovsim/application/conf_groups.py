"""List the options of the configuration's groups, without slow imports: the Tab key asks, too."""

from rovsim.core.shipped import conf_names
from rovsim.learning.learners import list_kinds

LEARNERS_GROUP = "residual"


def list_options(group: str) -> list[str]:
    """List the options of a group, sorted: its files, and learners that need none."""
    return sorted({*conf_names(group), *list_unwritten(group)})


def list_unwritten(group: str = LEARNERS_GROUP) -> set[str]:
    """Return the options whose values no file states: learners with their own defaults."""
    return set(list_kinds()) - set(conf_names(group)) if group == LEARNERS_GROUP else set()
