"""The gallery: a screen for each effect, with its equation, cause, picture and parameters."""

from base64 import b64encode
from html import escape
from pathlib import Path

from nicegui import ui

from rovsim.apps.workbench.parts import computed, formula, heading, section, table, text, words
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.shipped import shipped
from rovsim.core.signs import minus
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.effects.base import Effect, Signature
from rovsim.reporting.catalogue.entries import PICTURES, chaptered
from rovsim.reporting.units import unit

TITLE, QUESTION = "Effects", "What may a simulator lack, and what does it look like?"
PICTURES_FOLDER = shipped(f"docs/{PICTURES}")  # by `make catalogue`


async def show(bench: Workbench, place: Place) -> None:
    """Show all effects, grouped by where they act."""
    heading(TITLE, QUESTION)
    for chapter, effects in chaptered(bench.catalogue).items():
        section(chapter)
        with ui.element("div").classes("catalogue"):
            for cls in effects:
                with ui.element("div"):
                    ui.link(cls.id, f"/gallery/{cls.id}")
                    text((cls.__doc__ or "").split("\n")[0], "soft")


async def entry(bench: Workbench, effect: str) -> None:
    """Show one effect."""
    cls = bench.catalogue.get(effect)
    if cls is None:
        heading("No such effect", f"The catalogue does not know '{effect}'.")
        ui.link("All effects", "/gallery")
        return
    heading(cls.id, (cls.__doc__ or "").split("\n")[0])
    formula(cls.equation)
    await picture(bench, cls)
    if cls.signature is not None:
        hidden = ", ".join(f"{k} = {minus(f'{v:g}')}" for k, v in cls.signature.values.items())
        text(
            f"Hidden in a calm tank: {hidden}. Left: {_about(cls.signature)}; right: over time. "
            "Dots: what the nominal model misses; thick line: what the true effect adds.",
            "soft",
        )
    for title, body in (("Cause", cls.cause), ("What settles it", cls.revealed_by)):
        ui.html(f"<p><strong>{title}.</strong> {escape(body)}</p>", sanitize=False).classes("text")
    text(f"Neglects {cls.neglects}. Source: {cls.source}.", "soft")
    rows = [
        (p.name, [words(unit(p.unit) or "–"), words(minus(f"{p.scale:g}"))]) for p in cls.parameters
    ]
    table("Parameters", ["name", "unit", "a change worth looking for"], rows)
    ui.link("All effects", "/gallery")


async def picture(bench: Workbench, cls: type[Effect]) -> None:
    """Show the picture of an effect's signature; one that does not exist yet is drawn now."""
    if cls.signature is None:
        return
    path = PICTURES_FOLDER / f"{cls.id}.png"
    if not path.exists():
        path = bench.out / "pictures" / path.name
    if not path.exists():
        waiting = ui.spinner()
        await computed(_draw, cls, path, bench.catalogue)
        waiting.delete()
    about = f"{cls.id}: {_about(cls.signature)}"
    png = b64encode(path.read_bytes()).decode()
    ui.html(
        f'<img src="data:image/png;base64,{png}" alt="{escape(about)}">', sanitize=False
    ).classes("picture")


def _about(signature: Signature) -> str:
    return f"{signature.axis} error over {signature.condition}"


def _draw(cls: type[Effect], path: Path, catalogue: Catalogue) -> None:
    from rovsim.reporting.catalogue.flight import seen, settings
    from rovsim.reporting.figures.signature import draw_signature, write

    assert cls.signature is not None
    example = seen(cls.signature, settings(cls, cls.signature), catalogue)
    write(draw_signature(example), path)
