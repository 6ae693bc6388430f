"""The learners of residuals, one file each; every file in this folder is found.

A file declares `LEARNER` (`rovsim.learning.learner.Learner`) and is called after its kind; it need
not be registered anywhere. Its defaults are those of its settings, which a file in `conf/residual/`
may state for those who read there. What several learners use is in `rovsim.learning`.
"""

import pkgutil


def list_kinds() -> list[str]:
    """List the kinds of all learners, sorted; importing none of them, as that takes a second."""
    return sorted(module.name for module in pkgutil.iter_modules(__path__))
