"""Write what `compare`, `train` and `diagnose` print on the terminal."""

from typing import Mapping, Sequence

from rovsim.core.columns import fold
from rovsim.core.signs import minus
from rovsim.dynamics.effects.base import Effect
from rovsim.reporting.wording import (
    ERROR_MEANING,
    MIN_SHOWN_SHARE,
    fit,
    listed,
    percent,
    several,
    significant,
    title,
)
from rovsim.reporting.words.sentences import band_sentences, doubt_sentences
from rovsim.reporting.words.verdict import NO_TEST_RUN, Missing, explain
from rovsim.results.bands import Bands
from rovsim.results.base import or_nan
from rovsim.results.diagnosis import Diagnosis
from rovsim.results.error_conditions import ErrorConditions
from rovsim.results.fitted import FittedEffect
from rovsim.results.quality import Quality

BAR_LETTERS = 24
MAX_PRINTED_SENTENCES = 6  # the report has them all
MAX_RANKED_EFFECTS = 5
NO_ERROR_SENTENCE = (
    "No error of {} on the test runs: there it runs away within 2 s of the measured state. Usually "
    "a total drag is negative, or a value has the wrong sign."
)
ERROR_NOTE = f"{ERROR_MEANING}; here on the test runs. Fit is 100 % minus it (NRMSE fit)."


def tell_comparison(
    errors: Mapping[str, float | None],
    where: ErrorConditions,
    tested: bool,
    coverage: Bands | None = None,
    diverging: Sequence[str] = (),
) -> str:
    """Return a table of 2 s errors, what bands contain, and where the last model fails.

    Args:
        errors: 2 s error by model, in standard deviations; None where it has none.
        where: the errors over conditions.
        tested: whether there is a test run; if not, a sentence takes the place of the table.
        coverage: how much of the test runs lies inside the bands; None if unknown.
        diverging: models that diverge on the test runs.
    """
    table = _tell_errors(errors) if tested else ["", *fold(NO_TEST_RUN)]
    if tested and diverging:
        table += ["", *fold(NO_ERROR_SENTENCE.format(listed([title(name) for name in diverging])))]
    sentences = band_sentences(coverage) if coverage else []
    bands = [line for sentence in sentences for line in ("", *fold(sentence))]
    return "\n".join([*table, *bands, *_tell_findings(where)])


def tell_residual(without: float | None, corrected: float | None) -> str:
    """Say whether a residual helps on the test runs; empty where an error is unknown.

    Args:
        without: 2 s error of the base.
        corrected: 2 s error of the base with the residual.
    """
    if without is None or corrected is None:
        return ""
    share = corrected / without - 1.0
    text = f"On the test runs the residual {'lowers' if share < 0.0 else 'raises'} the error by "
    text += percent(abs(share))
    text += "." if share < 0.0 else ": the model is better without it."
    return "\n".join(["", "", *fold(text)])


def _tell_errors(errors: Mapping[str, float | None]) -> list[str]:
    lines = ["", *fold(ERROR_NOTE), ""]
    width = max((len(title(name)) for name in errors), default=0)
    most = max((e for e in errors.values() if e is not None), default=0.0) or 1.0
    lines += [
        f"  {title(n):<{width}}  {_bar((e or 0.0) / most)} {_format_error(e)}"
        for n, e in errors.items()
    ]
    return lines


def _format_error(error: float | None) -> str:
    return significant(or_nan(error)) + (
        f", fit {minus(f'{fit(error):.0f}')} %" if error is not None else ""
    )


def tell_doubts(quality: Mapping[str, Quality]) -> str:
    """Say what to check in the recordings before results are trusted; empty without doubts."""
    doubts = doubt_sentences(quality)
    printed, hidden = doubts[:MAX_PRINTED_SENTENCES], len(doubts) - MAX_PRINTED_SENTENCES
    lines = ["", "", "check the recordings first", ""] if doubts else []
    for doubt in printed:
        lines += fold(doubt, "  - ", "    ")
    return "\n".join([*lines, f"  … and {hidden} more in the report"] if hidden > 0 else lines)


def _tell_findings(where: ErrorConditions) -> list[str]:
    if not where.models:
        return []
    name, model = list(where.models.items())[-1]
    printed, hidden = (
        model.sentences[:MAX_PRINTED_SENTENCES],
        len(model.sentences) - MAX_PRINTED_SENTENCES,
    )
    head = f"where {title(name)} fails ({model.split} runs {several(model.runs)})"
    lines = ["", *fold(head), ""]
    for sentence in printed:
        lines += fold(sentence, "  - ", "    ")
    return [*lines, f"  … and {hidden} more in the report"] if hidden > 0 else lines


def tell_diagnosis(diagnosis: Diagnosis, catalogue: Mapping[str, type[Effect]]) -> str:
    """Return the verdict, the selected effects, and the best effects alone, with bars."""
    verdict = explain(diagnosis, catalogue)
    lines = ["", *fold(f"{verdict.sentence} (verdict: {verdict.name})")]
    lines += [""] if verdict.missing else []
    for fitted, words in zip(diagnosis.selected, verdict.missing, strict=True):
        lines += _tell_effect(fitted.error_reduction or 0.0, words)
    lines += ["", *fold(verdict.key)] if verdict.key else []
    lines += _tell_ranking(diagnosis.ranking)
    steps = [f"Next: {verdict.next}"] if verdict.next else []
    for remark in (*verdict.sentences, *steps):
        lines += ["", *fold(remark)]
    return "\n".join(lines)


def tell_roles(quality: Mapping[str, Quality]) -> str:
    """Say for each run whether it is a train or a test run, and why it is not used."""
    lines = []
    for name, report in quality.items():
        reason = f", not used: {report.unusable}" if report.unusable else ""
        lines += fold(f"{name}: {report.split} run{reason}", "  ", "    ")
    return "\n".join(["", "", *lines])


def _tell_effect(share: float, words: Missing) -> list[str]:
    reduction, _, sureness = words.worth.partition(", ")
    values = [f"      {value}" for value in words.parameters]
    return [f"  {words.effect:<22}{_bar(share)} {reduction}", f"      {sureness}", *values]


def _tell_ranking(ranking: Sequence[FittedEffect]) -> list[str]:
    helping = [(r.error_reduction or 0.0, r.effect) for r in ranking]
    top = sorted((pair for pair in helping if pair[0] >= MIN_SHOWN_SHARE), reverse=True)[
        :MAX_RANKED_EFFECTS
    ]
    if not top:
        return []
    rows = [f"  {effect:<22}{_bar(share)} {100 * share:.0f} %" for share, effect in top]
    return ["", "error that each effect removes alone, at its first estimate:", *rows]


def _bar(share: float) -> str:
    full = max(0, min(BAR_LETTERS, round(BAR_LETTERS * share)))
    return "█" * full + "·" * (BAR_LETTERS - full)
