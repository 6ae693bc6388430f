"""`marks.json` and `mistakes.json` in words and tables: for the report, and docs/thesis.md."""

from typing import Any, Mapping

from rovsim.evaluation.held_out.pitfalls import MISTAKES
from rovsim.evaluation.held_out.published import COUNTED, METRICS, PUBLISHED
from rovsim.evaluation.ladder import EFFECTS
from rovsim.reporting.figures.marks import significant
from rovsim.reporting.html.marked import table
from rovsim.reporting.tables import QUANTITIES


def said(marks: Mapping[str, Any]) -> list[str]:
    """One sentence for each residual on top of effects: how many cells, how far, which not."""
    models = marks.get("models", {})
    return [_sentence(n, found) for n, found in models.items() if n.startswith(f"{EFFECTS}+")]


def _sentence(name: str, found: Mapping[str, Any]) -> str:
    missed = ", ".join(
        f"{c['run']} {c['axis']} {QUANTITIES[c['metric']][0]} ({_number(c['ratio'])})"
        for c in found["not_below"]
    )
    return (
        f"{name}: {found['below']} of {found['cells']} cells below the mark, geometric mean of the "
        f"ratios {_number(found['geometric_mean'])}. " + (f"Not below: {missed}." if missed else "")
    ).strip()


def repeated(mistakes: Mapping[str, Any]) -> list[str]:
    """One sentence for each mistake: what was done, and what it cost on each run."""
    runs = mistakes.get("runs", {})
    return [
        f"{name[0].upper()}{name[1:]}: {done}. {measure[0].upper()}{measure[1:]}: {costs}."
        for name, (done, measure) in MISTAKES.items()
        if (costs := _costs(runs, name))
    ]


def _costs(runs: Mapping[str, Any], name: str) -> str:
    return ", ".join(
        f"{_number(found[name]['right'])} becomes {_number(found[name]['wrong'])} ({run})"
        for run, found in runs.items()
        if name in found
    )


def text(marks: Mapping[str, Any]) -> list[str]:
    """Paragraphs of Markdown of `marks.json`."""
    lacking = marks["without_published"]
    parts = [*said(marks), _standings(marks)]
    parts += [part for metric in METRICS for part in _cells(marks, metric)]
    return parts + ([f"Nothing is published for {', '.join(lacking)}."] if lacking else [])


def _standings(marks: Mapping[str, Any]) -> str:
    head = ["model", "below the mark", "geometric mean of the ratios",
            *(QUANTITIES[metric][0] for metric in METRICS)]  # fmt: skip
    rows = [
        [name, f"{found['below']} of {found['cells']}", _number(found["geometric_mean"]),
         *(_number(found["by_metric"][m]["geometric_mean"]) for m in METRICS)]
        for name, found in marks["models"].items()
    ]  # fmt: skip
    return table(head, rows)


def _cells(marks: Mapping[str, Any], metric: str) -> list[str]:
    """Heading and table of one metric: the mark, whose it is, and the ratios of our models."""
    heading, units = QUANTITIES[metric]
    ours = [name for name in marks["models"] if not name.startswith(PUBLISHED)]
    rows = [
        [cell["run"], cell["axis"] if cell["demanded"] else f"({cell['axis']})",
         significant(cell["mark"]), f"{cell['best']['model']}, {cell['best']['variant']}",
         *(_number(cell["ratios"].get(name)) for name in ours)]
        for cell in marks["cells"] if cell["metric"] == metric
    ]  # fmt: skip
    extra = "" if metric in COUNTED else ", not counted above"
    units_text = " and ".join(dict.fromkeys(units))
    return [
        f"### {heading[0].upper()}{heading[1:]}",
        f"The mark in {units_text}, whose it is, and our errors divided by it{extra}.",
        table(["run", "axis", "mark", "smallest published", *ours], rows),
    ]


def _number(value: float | None) -> str:
    return "–" if value is None else significant(value)
