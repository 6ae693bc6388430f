"""Where Hydra looks: in each folder of the configuration, the working folder's own first."""

from hydra.core.config_search_path import ConfigSearchPath
from hydra.core.plugins import Plugins
from hydra.plugins.search_path_plugin import SearchPathPlugin

from rovsim.core.shipped import conf_folders


class ConfFolders(SearchPathPlugin):
    """Adds the folders after the first, which Hydra is given."""

    def manipulate_search_path(self, search_path: ConfigSearchPath) -> None:
        """Called by Hydra as it sets itself up."""
        for folder in conf_folders()[1:]:
            search_path.append("rovsim", f"file://{folder}")


def first_folder() -> str:
    """The folder to give to Hydra, which searches the others from now on too."""
    Plugins.instance().register(ConfFolders)
    return str(conf_folders()[0])
