"""The screen Why: which effects are missing, how sure that is, and what to record next."""

from html import escape
from pathlib import Path
from typing import Sequence

from nicegui import ui

from rovsim.apps.workbench import jobs
from rovsim.apps.workbench.gallery import picture
from rovsim.apps.workbench.on_your_data import show_lowered
from rovsim.apps.workbench.parts import (
    Failure,
    bar,
    cell,
    computed,
    formula,
    heading,
    onward,
    paragraphs,
    png,
    section,
    table,
    text,
    tile,
    words,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import AXES, FORCE_UNITS
from rovsim.core.errors import RovsimError
from rovsim.reporting.wording import (
    ERROR_NAME,
    MIN_TOLD_PROBABILITY,
    percent,
    significant,
    tell_probability,
)
from rovsim.reporting.words.intervals import interval
from rovsim.reporting.words.verdict import Missing, explain
from rovsim.results.diagnosis import Diagnosis, Disturbance
from rovsim.results.error_conditions import ConditionShare
from rovsim.results.fitted import FittedEffect

TITLE, QUESTION = "Why", "Which physics is missing?"
OLD_VERSION_WARNING = (
    "An earlier version wrote this file, which does not say of which recordings it is: make sure "
    "that these are those of this campaign."
)
MAX_RANKED_EFFECTS = 8  # effects of the ranking, unless more are likely


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    heading(TITLE, QUESTION)
    if bench.diagnosis is None:
        _ask(bench)
        return
    diagnosis = bench.diagnosis
    if bench.settings.diagnosis and not diagnosis.recordings:
        text(OLD_VERSION_WARNING, "warning")
    verdict = explain(diagnosis, bench.catalogue)
    ui.html(
        f"<p><strong>{escape(verdict.sentence)}</strong> <span>({escape(verdict.name)})</span></p>",
        sanitize=False,
    ).classes("verdict")
    _show_errors(diagnosis)
    text(verdict.error)
    if verdict.key:
        text(verdict.key, "soft")
    rooms = {missing.effect: _effect(missing) for missing in verdict.missing}
    await _show_unexplained(bench, diagnosis)
    if diagnosis.selected:
        onward("Add what is missing", "/add")
    if verdict.next:
        section("What to record next")
        text(verdict.next, "next")
        onward("Plan the flight", "/flight")
    paragraphs("What else to know", verdict.remarks)
    _show_ranking(diagnosis)
    button = jobs.Beginning(bench, "Diagnose again", on_click=lambda: jobs.start_diagnosis(bench))
    button.props("flat no-caps").classes("onward")
    for effect, room in rooms.items():
        with room:
            await _show_effect(bench, effect)


def _ask(bench: Workbench) -> None:
    text(
        "Every effect of the catalogue is fitted to the train runs, alone and together, and has "
        "to prove itself on stretches it was not fitted to. The test runs stay closed until the "
        "end. This takes from ten seconds to some minutes."
    )
    button = jobs.Beginning(
        bench, "Find what is missing", icon="search", on_click=lambda: jobs.start_diagnosis(bench)
    )
    button.props("unelevated no-caps").classes("onward")


def _show_errors(diagnosis: Diagnosis) -> None:
    error = diagnosis.error
    with ui.row().classes("tiles"):
        tile(f"{ERROR_NAME} of the model", error.nominal, "error/nominal", "test runs")
        if diagnosis.selected:
            tile("With the effects", error.with_effects, "error/with_effects", "test runs")
        tile("Noise floor", error.noise_floor, "error/noise_floor", "of a perfect model, about")


def _effect(missing: Missing) -> ui.column:
    """Show the card of a missing effect; returns the space for its picture."""
    with ui.row().classes("card effect"):
        with ui.column().classes("words"):
            ui.html(f"<h2>{escape(missing.effect)}</h2>", sanitize=False)
            text(missing.meaning)
            with ui.row().classes("values"):
                for value in missing.parameters:
                    ui.label(value).classes("value")
            text(f"It {missing.worth}.")
            if missing.equation:
                formula(missing.equation)
                text(f"Usual cause: {missing.cause}")
                ui.link("What it looks like, and how to be sure", f"/gallery/{missing.effect}")
        return ui.column().classes("seen")


async def _show_effect(bench: Workbench, effect: str) -> None:
    """Show how an effect lowers the error in the user's data, or else the gallery's picture."""
    if await show_lowered(bench, effect):
        return
    if cls := bench.catalogue.get(effect):
        await picture(bench, cls)
        ui.label("From the gallery: what it looks like in a calm tank, not your data.")


async def _show_unexplained(bench: Workbench, diagnosis: Diagnosis) -> None:
    """Show what no effect explains: the law that is proposed for it, or the force over time."""
    law = diagnosis.unexplained.proposal
    if law is not None:
        with ui.column().classes("card effect"):
            ui.html("<h2>A law for what is left</h2>", sanitize=False)
            text(law.meaning)
            formula(law.equation)
            with ui.row().classes("values"):
                for name, value in law.parameters.items():
                    ui.label(f"{name} {interval(value)}").classes("value")
            text(f"It removes {percent(law.error_reduction)} of the error. ± is a 95 % interval.")
            text(f"An effect of your own, to be read and changed: {bench.law_path}", "soft")
            add = ui.button("Add the law").props("unelevated no-caps")
            failure = Failure()
            add.on_click(lambda: _take(bench, failure))
    elif diagnosis.unexplained.disturbance is not None:
        section("A disturbance, and no law")
        path = bench.out / "pictures" / "disturbance.png"
        await computed(draw_disturbance, diagnosis.unexplained.disturbance, path)
        png(path, "What pushes and follows no law: on the path, in time and by frequency")


def _take(bench: Workbench, failure: Failure) -> None:
    try:
        bench.take_law()
    except RovsimError as error:
        failure.tell(error)
        return
    ui.navigate.to("/add")


def draw_disturbance(force: Disturbance, path: Path) -> None:
    """Draw the report's figure of the disturbance into a file."""
    from rovsim.reporting.figures import find_figure
    from rovsim.reporting.figures.style import save

    save(find_figure("disturbance").draw(disturbance=force), path.parent, path.stem)


def _show_ranking(diagnosis: Diagnosis) -> None:
    if ranking := list_worth_showing(diagnosis.ranking):
        section("Each effect alone")
        text(
            "As if one effect alone were missing, the likeliest first. Where several are missing, "
            "an effect that is certain beside the others may be unlikely alone.",
            "soft",
        )
        rows = [
            (
                r.effect,
                [
                    bar(r.error_reduction or 0.0, f"ranking/{r.effect}/error_reduction"),
                    cell(
                        r.probability,
                        f"ranking/{r.effect}/probability",
                        tell_probability(r.probability),
                    ),
                ],
            )
            for r in ranking
        ]
        table(
            "Error that each effect removes by itself, at its first estimate",
            ["effect", "error removed", "probability, if one alone is missing"],
            rows,
        )
    if diagnosis.where:
        section("Where the model fails")
        rows = [(w.axis, [words(w.condition), words(tell_share(w))]) for w in diagnosis.where]
        table("Conditions the error varies with", ["axis", "condition", "share of error"], rows)


def tell_share(one: ConditionShare) -> str:
    """Say which share of an error varies with a condition; of a constant error also its force."""
    share = percent(one.share_of_error)
    if one.push is None:
        return share
    unit = FORCE_UNITS[AXES.index(one.axis)]
    return f"{share}: a push of {significant(abs(one.push), 2)} {unit}"


def list_worth_showing(ranking: Sequence[FittedEffect]) -> list[FittedEffect]:
    """List all effects that are not improbable, the likeliest first, then those that remove most.

    In all `MAX_RANKED_EFFECTS`, unless more are likely.
    """
    likely = [r for r in ranking if (r.probability or 0.0) >= MIN_TOLD_PROBABILITY]
    likely.sort(key=lambda r: -(r.probability or 0.0))
    rest = [r for r in ranking if r not in likely and (r.error_reduction or 0.0) > 0.0]
    rest.sort(key=lambda r: -(r.error_reduction or 0.0))
    return likely + rest[: max(0, MAX_RANKED_EFFECTS - len(likely))]
