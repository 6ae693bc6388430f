"""Open the workbench in the browser: how far apart, where, why, and is the new model better?

rovsim ui [campaign=DIR] [model=[nominal,FILE,…]] [diagnosis=OUT/diagnosis.json] [port=8501]
          [open=true]

Served on this machine only, without the internet, until Ctrl+C. Without a campaign it offers those
in this folder, and one to practise on; a campaign, model or diagnosis that cannot be opened is
refused. What it computes lies in `out` (results/CAMPAIGN/ui). Needs the extra rovsim[workbench].
"""

import socket
from pathlib import Path

from rovsim.application.settings import WorkbenchSettings
from rovsim.apps.cli.output import say
from rovsim.apps.workbench import HOST
from rovsim.core.errors import BadInput
from rovsim.core.extras import require
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.vehicle import load_vehicle
from rovsim.measurement.loading import load_campaign
from rovsim.results.diagnosis import Diagnosis


class Settings(WorkbenchSettings):
    """What `rovsim ui` takes."""


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Serve until interrupted."""
    require("workbench", by="rovsim ui")
    _free(settings.port)
    _check(settings, catalogue)
    from rovsim.apps.workbench.app import serve

    address = f"http://{HOST}:{settings.port}"
    say(settings, f"The workbench is at {address} (Ctrl+C ends it)", {"address": address})
    serve(settings, catalogue)


def _check(settings: Settings, catalogue: Catalogue) -> None:
    """Refuse what was named and cannot be opened; recordings are read later, on the page."""
    if settings.campaign is not None:
        campaign = load_campaign(Path(settings.campaign))
        vehicle = load_vehicle(campaign.vehicle, named_in=campaign.file)
        if settings.model != "nominal":
            from rovsim.application.pipeline.models import load_models  # a second to import

            load_models(settings.model, vehicle, catalogue)
    if settings.diagnosis is not None:
        Diagnosis.read(Path(settings.diagnosis))


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
