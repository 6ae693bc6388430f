"""A workbench, opened without a browser."""

import pytest

from rovsim.application.configuration import compose
from rovsim.apps.cli.main import main
from rovsim.apps.workbench.workbench import Workbench
from rovsim.dynamics.catalogue import built_in


@pytest.fixture(scope="module")
def bench(tmp_path_factory):
    """A workbench with a tiny campaign, in a folder of its own."""
    folder = tmp_path_factory.mktemp("desk")
    main(["tank", "tank=tiny", "tank.duration=8", f"out={folder / 'raw'}", "-q"])
    settings = compose([f"campaign='{folder / 'raw'}'", f"out='{folder / 'out'}'"])
    return Workbench.opened(settings, built_in())
