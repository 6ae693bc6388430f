"""Let Hydra search every folder of the configuration, the working folder's own first."""

from hydra.core.config_search_path import ConfigSearchPath
from hydra.core.plugins import Plugins
from hydra.plugins.search_path_plugin import SearchPathPlugin

from rovsim.core.shipped import conf_folders


class ConfFolders(SearchPathPlugin):
    """Adds all folders of the configuration but the first, which Hydra gets directly."""

    def manipulate_search_path(self, search_path: ConfigSearchPath) -> None:
        """Append the folders; Hydra calls this as it starts."""
        for folder in conf_folders()[1:]:
            search_path.append("rovsim", f"file://{folder}")


def first_folder() -> str:
    """Return the folder to give to Hydra, and make Hydra search the others from now on."""
    Plugins.instance().register(ConfFolders)
    return str(conf_folders()[0])
