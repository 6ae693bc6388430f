"""Write a model for another simulator.

rovsim export model=FILE to=gz|stonefish|mss|fossen out=FILE [campaign=DIR]

gz: a world for Gazebo (SDF); stonefish: a scenario; mss: a MATLAB function like those of Fossen's
MSS; fossen: matrices and coefficients as YAML. What the simulator cannot hold is listed in the file
and here, with the size of its force over a typical flight, or over the runs of a campaign.
docs/export.md says what each of them holds.
"""

from functools import partial
from pathlib import Path
from typing import Sequence

from rovsim.application.export.sizes import Sized, flights
from rovsim.application.export.targets import Target, target, targets
from rovsim.application.export.write import TYPICAL_FLIGHT, export_model, model_parts, write_export
from rovsim.application.pipeline.measured_campaign import measure, open_campaign
from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.application.settings import CampaignSettings
from rovsim.apps.cli.output import say
from rovsim.core.axes import AXES
from rovsim.core.columns import fold
from rovsim.core.errors import BadInput
from rovsim.core.model_names import BUILT_IN
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import load_model
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle
from rovsim.measurement.signals.motion import Motion
from rovsim.reporting.words.totals import warn_totals


class Settings(CampaignSettings):
    """What `rovsim export` takes."""

    to: str


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Write the file, and say what is left out."""
    chosen = _target(settings)
    model = _model(settings, catalogue)
    out = Path(settings.out or f"{model.name}{chosen.suffix}")
    over = f"the runs of {settings.campaign}" if settings.campaign else TYPICAL_FLIGHT
    export = export_model(model, chosen, partial(_flown, settings, model), over, model_parts(model))
    write_export(export, out)
    warning = warn_totals(model.body)
    lines = [_format_summary(f"{out}: {_name(model)}", chosen, export.left, over), *fold(warning)]
    content = _content(out, chosen, export.left) | {"model": model.name, "warning": warning}
    say(settings, "\n".join(lines), content)


def _target(settings: Settings) -> Target:
    if settings.to != "nominal":  # that is what `rovsim add` takes where nothing is given
        return target(settings.to)
    raise BadInput(
        "no simulator was named",
        where="to",
        expected=f"one of {', '.join(targets())}",
        remedy="For example to=gz.",
    )


def _model(settings: Settings, catalogue: Catalogue) -> Model:
    if not isinstance(settings.model, str):
        raise BadInput(
            f"{len(settings.model)} models",
            where="model",
            expected="one model",
            remedy="Export one after the other.",
        )
    if settings.campaign is None:
        vehicle = load_vehicle(default_vehicle())
    else:
        vehicle = load_campaign_vehicle(open_campaign(settings.campaign))
    return load_model(settings.model, vehicle, catalogue)


def _flown(settings: Settings, model: Model) -> list[Motion]:
    """What forces are sized over; a campaign is measured only where something is left out."""
    if settings.campaign is None:
        return flights(model, None)
    data = measure(open_campaign(settings.campaign), settings.signals)
    return flights(model, data.motions.values())


def _name(model: Model) -> str:
    """Which model it is; of the nominal one, also how another is named."""
    if model.name in BUILT_IN:
        return f"the nominal model of {model.vehicle.name} (model=FILE writes one with effects)"
    return f"the model {model.name}"


def _format_summary(head: str, chosen: Target, left: Sequence[Sized], over: str) -> str:
    """`head`: the file, and what is in it."""
    if not left:
        sentence = f"{chosen.title} holds the whole model. {chosen.takes}"
        return "\n".join([*fold(head), *fold(sentence)])
    lines = fold(f"Left out for {chosen.title}, with the RMS force over {over}:")
    for part in left:
        lines += [f"  {part.name}: {_largest(part)}", *fold(part.why, " " * 6)]
    return "\n".join([*fold(head), *lines, *fold(chosen.takes)])


def _largest(one: Sized) -> str:
    """The largest force and the largest moment."""
    parts = []
    for axes, unit in ((slice(0, 3), "N"), (slice(3, 6), "N m")):
        value, axis = max(zip(one.rms[axes], AXES[axes], strict=True))
        if value > 0.0:
            parts.append(f"{value:.3g} {unit} ({axis})")
    return ", ".join(parts) or "no force"


def _content(out: Path, chosen: Target, left: Sequence[Sized]) -> dict[str, object]:
    return {
        "file": str(out),
        "to": chosen.name,
        "left_out": [
            {"name": part.name, "why": part.why, "rms": dict(zip(AXES, part.rms, strict=True))}
            for part in left
        ],
    }
