"""Write a model for another simulator, and say what that simulator cannot hold."""

from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Sequence

from rovsim.application.export.equation import Equation
from rovsim.application.export.holding import OmittedPart, leave_out
from rovsim.application.export.sizes import Sized, size_all
from rovsim.application.export.targets import Target
from rovsim.core.axes import AXES
from rovsim.core.errors import BadInput
from rovsim.core.files import require_replaceable, write_text
from rovsim.dynamics.model import Model
from rovsim.measurement.signals.motion import Motion

TYPICAL_FLIGHT = "a typical flight of a minute"
WRITTEN_BY = "written by rovsim for"  # stands in every file


@dataclass(frozen=True, eq=False)
class ExportedModel:
    """A model as a target can hold it.

    Attributes:
        text: of the file.
        left: parts that are left out, with the sizes of their forces.
    """

    text: str
    left: tuple[Sized, ...]


def represent(model: Model, target: Target) -> tuple[Model, list[OmittedPart]]:
    """Reduce a model to what a target can hold.

    Returns:
        That model, and all parts that are left out.

    Raises:
        BadInput: the model does not react to forces, or lacks inertia along axes that are held in
            the model but free in the target.
    """
    if model.inert:
        raise BadInput(
            f"{model.name} keeps its velocity whatever pushes",
            where="model",
            expected="a model that forces move",
            remedy="Name nominal, or a model file.",
        )
    parts = list(leave_out(model, target.hold))
    reduced = parts[-1].after if parts else model
    if not reduced.possible:
        raise BadInput(
            f"{model.name} has axes that are held, and no inertia along them",
            where="model",
            expected=f"inertia about all axes, for {target.title} moves them all",
            remedy="Give the vehicle file Ixx, Iyy and added mass of those axes, or write it for "
            "a simulator that holds axes (to=mss).",
        )
    return reduced, [*parts, *target.further(reduced)]


def export_model(
    model: Model, target: Target, flights: Callable[[], Sequence[Motion]], over: str, origin: str
) -> ExportedModel:
    """Convert a model to a target's file, and measure what is left out.

    Args:
        model: what is written.
        target: the simulator it is written for.
        flights: returns true motions over which forces are measured; called only if something is
            left out.
        over: description of these motions, for the reader.
        origin: description of what the model is made of.

    Raises:
        BadInput: the target cannot hold such a model at all.
    """
    reduced, parts = represent(model, target)
    sized = size_all(parts, flights()) if parts else []
    notes = [f"{model.name}, {WRITTEN_BY} {target.title}.", f"Model: {origin}"]
    notes += [f"Format: {target.source}.", target.takes, *_listed(sized, over)]
    return ExportedModel(target.text(Equation(reduced), notes), tuple(sized))


def model_parts(model: Model) -> str:
    """Describe in a line what a model is made of."""
    parts = [model.vehicle.name, *(repr(effect) for effect in model.added)]
    return " + ".join(parts + (["a learned residual"] if model.residual else []))


def write_export(export: ExportedModel, out: Path) -> None:
    """Write the file, whole or not at all.

    Raises:
        BadInput: `out` is a file that rovsim did not write.
    """
    require_replaceable(out, WRITTEN_BY)
    write_text(out, export.text)


def _listed(sized: Sequence[Sized], over: str) -> list[str]:
    """List what is left out, as lines of a comment."""
    if not sized:
        return ["Nothing of the model is left out."]
    units = f"{', '.join(AXES[:3])} in N, {', '.join(AXES[3:])} in N m"
    head = [f"LEFT OUT, with the RMS of its force over {over}", f"({units}):"]
    return head + [
        f"  {part.name}: {' '.join(f'{v:.3g}' for v in part.rms)}  ({part.why})" for part in sized
    ]
