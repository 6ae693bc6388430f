"""Pack a model as an FMI 2.0 co-simulation unit.

rovsim fmu model=nominal|FILE out=vehicle.fmu

The unit holds the model and its residual, not the simulator: the machine that runs it needs rovsim
in the Python that its FMI tool loads (docs/elsewhere.md). Needs the extra rovsim[fmi].
"""

from pathlib import Path

from rovsim.application.settings import WritingSettings
from rovsim.apps.cli.output import say
from rovsim.apps.fmi.unit import write_unit
from rovsim.core.errors import BadInput
from rovsim.core.extras import require
from rovsim.core.model_names import BUILT_IN, ZERO_ACCELERATION
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model_file import load_model
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle


class Settings(WritingSettings):
    """What `rovsim fmu` takes."""

    model: str | list[str]


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Write the unit."""
    require("fmi", by="rovsim fmu")
    spec = settings.model
    if not isinstance(spec, str) or spec == ZERO_ACCELERATION or catalogue.files:
        raise BadInput(
            f"model {spec}" + (", effects_file" if catalogue.files else ""),
            where="rovsim fmu",
            expected="one model, of effects that are installed",
            remedy="Name one model file; install effects of your own (docs/your_own_effect.md).",
        )
    out = Path(settings.out or "results/vehicle.fmu")
    model = load_model(spec, load_vehicle(default_vehicle()), catalogue)
    write_unit(model, None if spec in BUILT_IN else Path(spec), out)
    say(settings, str(out), {"unit": str(out)})
