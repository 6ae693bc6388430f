"""Let Hydra search every folder of the configuration, the working folder's own first.

Learners without a file there take the defaults of their settings.
"""

from hydra.core.config_search_path import ConfigSearchPath
from hydra.core.config_store import ConfigStore
from hydra.core.plugins import Plugins
from hydra.plugins.search_path_plugin import SearchPathPlugin

from rovsim.application.conf_groups import LEARNERS_GROUP, list_unwritten
from rovsim.core.shipped import conf_folders


class ConfFolders(SearchPathPlugin):
    """Adds all folders of the configuration but the first, which Hydra gets directly."""

    def manipulate_search_path(self, search_path: ConfigSearchPath) -> None:
        """Append the folders; Hydra calls this as it starts."""
        for folder in conf_folders()[1:]:
            search_path.append("rovsim", f"file://{folder}")


def first_folder() -> str:
    """Return the folder to give to Hydra, and make Hydra find everything else from now on."""
    Plugins.instance().register(ConfFolders)
    for kind in list_unwritten():
        _store_defaults(kind)
    return str(conf_folders()[0])


def _store_defaults(kind: str) -> None:
    """Store the defaults of a learner as an option; Hydra hands what is stored to its workers."""
    from rovsim.learning.learner import learner_settings  # loads the compiler

    defaults = learner_settings({"kind": kind}).model_dump(mode="json")
    ConfigStore.instance().store(name=kind, node=defaults, group=LEARNERS_GROUP)
