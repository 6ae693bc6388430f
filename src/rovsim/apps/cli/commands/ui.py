"""Open the workbench in the browser: how far apart, where, why, and is the new model better?

rovsim ui [campaign=DIR] [model=[nominal,FILE,…]] [diagnosis=OUT/diagnosis.json] [port=8501]
          [open=true]

Served on this machine only, without the internet, until Ctrl+C. Without a campaign it offers those
in this folder, and one to practise on. What it computes lies in `out` (results/CAMPAIGN/ui). Needs
the extra rovsim[workbench].
"""

import socket

from rovsim.application.settings import WorkbenchSettings
from rovsim.apps.cli.output import say
from rovsim.apps.workbench import HOST
from rovsim.core.errors import BadInput
from rovsim.core.extras import require
from rovsim.dynamics.catalogue import Catalogue


class Settings(WorkbenchSettings):
    """What `rovsim ui` takes."""


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Serve until interrupted."""
    require("workbench", by="rovsim ui")
    _free(settings.port)
    from rovsim.apps.workbench.app import serve

    address = f"http://{HOST}:{settings.port}"
    say(settings, f"The workbench is at {address} (Ctrl+C ends it)", {"address": address})
    serve(settings, catalogue)


def _free(port: int) -> None:
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError as error:
            raise BadInput(
                f"port {port} cannot be used ({error.strerror})",
                where="port",
                expected="a free port of this machine",
                remedy=f"Give another one, for example port={port + 1}.",
            ) from None
