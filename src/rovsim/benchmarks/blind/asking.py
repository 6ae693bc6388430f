"""The project's own diagnosis as a method, with the settings a user gets."""

from pathlib import Path
from typing import Any

from rovsim.application.loading import measured
from rovsim.application.settings import compose
from rovsim.diagnosis.of_campaign import diagnosed
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.model import nominal


def diagnosis(campaign: Path, out: Path) -> dict[str, Any]:
    """What `rovsim diagnose` writes, without the report."""
    settings = compose(["command=diagnose"]).model_copy(update={"campaign": str(campaign)})
    data = measured(settings, even_unusable=True)
    base = nominal(data.vehicle)
    found = diagnosed(data.runs, base, settings.diagnosing, built_in(), lambda name: None)
    return found.content
