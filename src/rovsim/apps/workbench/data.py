"""The screen Data: what was recorded, what is doubtful in it, and which axes moved enough."""

from pathlib import Path
from typing import Mapping

from nicegui import ui

from rovsim.apps.workbench.chart_axes import INK, LINE, SOFT, Options, named_below
from rovsim.apps.workbench.charts import MARK_COLOR
from rovsim.apps.workbench.parts import (
    Failure,
    cell,
    chart,
    heading,
    paragraphs,
    section,
    table,
    text,
    words,
)
from rovsim.apps.workbench.place import Place
from rovsim.apps.workbench.workbench import Workbench
from rovsim.core.axes import AXES, VELOCITY_UNITS
from rovsim.core.errors import RovsimError
from rovsim.core.files import read_text, write_text
from rovsim.reporting.words.sentences import doubt_sentences
from rovsim.results.quality import Quality

NOTES_FILE = "notes.md"
TITLE, QUESTION = "Data", "Can these recordings be trusted?"


async def show(bench: Workbench, place: Place) -> None:
    """Show the screen."""
    heading(TITLE, QUESTION)
    quality = bench.data.quality
    for doubt in doubt_sentences(quality):
        text(doubt, "warning")
    _recordings(quality)
    _gaps(quality)
    _excitation(quality)
    paragraphs("Remarks", list_remarks(quality))
    _notes(bench.data.campaign.file.with_name(NOTES_FILE))


def list_remarks(quality: Mapping[str, Quality]) -> list[str]:
    """List the remarks on runs that are no doubts; the screen shows doubts above."""
    if not any(report.remarks for report in quality.values()):
        return ["Nothing to remark on."]
    return [f"{run}: {remark}" for run, report in quality.items() for remark in report.others]


def _notes(file: Path) -> None:
    """Show the notes beside campaign.yaml, which are saved while somebody types."""
    section("Notes")
    content = read_text(file) if file.exists() else ""

    def keep() -> None:
        try:
            write_text(file, box.value or "")
        except RovsimError as error:
            failure.tell(error)
        else:
            failure.forget()

    box = ui.textarea(f"Kept in {file}", value=content, on_change=keep).classes("notes")
    box.props("outlined autogrow")
    failure = Failure()


def _recordings(quality: Mapping[str, Quality]) -> None:
    rows = []
    for run, q in quality.items():
        rows.append(
            (
                run,
                [
                    words(q.split),
                    words(q.control),
                    cell(q.rate_hz.median, f"{run}/rate_hz"),
                    cell(q.duration_s, f"{run}/duration_s"),
                    cell(q.not_found, f"{run}/not_found"),
                    cell(len(q.gaps), f"{run}/gaps"),
                    cell(q.longest_gap_s, f"{run}/longest_gap_s"),
                    cell(q.outliers, f"{run}/outliers"),
                    cell(q.repairs["duplicates"], f"{run}/duplicates"),
                    cell(_times(q.noise.position_m, 1e3), f"{run}/noise_mm"),
                    cell(_times(q.noise.attitude_rad, 1e3), f"{run}/noise_mrad"),
                ],
            )
        )
    heads = [
        "run", "split", "control", "rate (Hz)", "length (s)", "frames without pose", "gaps",
        "longest (s)", "outliers", "duplicates", "noise (mm)", "noise (mrad)",
    ]  # fmt: skip
    table("Recordings: noise is per sample of the raw poses", heads, rows)


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def _gaps(quality: Mapping[str, Quality]) -> None:
    """Show each run as a line over time, with its gaps as marks."""
    section("Gaps")
    runs = list(quality)[::-1]
    data = [
        [gap.start_s, k, gap.start_s + gap.duration_s]
        for k, run in enumerate(runs)
        for gap in quality[run].gaps
    ]
    if not data:
        text("The body was seen throughout.", "soft")
        return
    text("Where the motion capture lost the body. Nothing is invented across a long gap.", "soft")
    chart(
        _chart_of_gaps(data, runs, max(quality[run].duration_s for run in runs)),
        "Gaps in each run over time",
        60 + 30 * len(runs),
        columns={"names": ("from (s)", "run", "to (s)")},
    )


GAP_SHAPE = (
    "(p, api) => { const a = api.coord([api.value(0), api.value(1)]),"
    " b = api.coord([api.value(2), api.value(1)]);"
    " return {type: 'rect', shape: {x: a[0], y: a[1] - 9, width: Math.max(2, b[0] - a[0]),"
    " height: 18}, style: {fill: '#D55E00'}}; }"
)


def _chart_of_gaps(gaps: list[list[float]], runs: list[str], longest: float) -> Options:
    """Return a chart of gaps over the time in each run.

    Args:
        gaps: beginning (s), number of the run, and end (s) of each.
        runs: from bottom to top.
        longest: duration of the longest run, s.
    """
    return {
        "grid": {"left": 8, "right": 24, "top": 8, "bottom": 34, "containLabel": True},
        "tooltip": {
            ":formatter": "p => p.value[0].toFixed(2) + ' s to ' + p.value[2].toFixed(2) + ' s'"
        },
        "xAxis": {
            "type": "value",
            "min": 0,
            "max": longest,
            **named_below("time in the run (s)", 22),
            "axisLabel": {"color": SOFT, "showMaxLabel": False},
            "splitLine": {"show": False},
        },
        "yAxis": {
            "type": "category",
            "data": runs,
            "axisLabel": {"color": INK},
            "axisTick": {"show": False},
            "splitLine": {"show": True, "lineStyle": {"color": LINE}},
        },
        "series": [
            {
                "type": "custom",
                "data": gaps,
                ":renderItem": GAP_SHAPE,
                "encode": {"x": [0, 2], "y": 1},
                "itemStyle": {"color": MARK_COLOR},
            }
        ],
    }


def _excitation(quality: Mapping[str, Quality]) -> None:
    section("Excitation")
    text("An axis in parentheses hardly moves: nothing can be judged there.", "soft")
    heads = ["run", *(f"{a} ({u})" for a, u in zip(AXES, VELOCITY_UNITS, strict=True))]
    rows = []
    for run, report in quality.items():
        cells = []
        for axis in AXES:
            excitation = report.excitation.get(axis)
            markup = cell(excitation.std if excitation else None, f"{run}/excitation/{axis}")
            quiet = excitation is not None and not excitation.excited
            cells.append(markup.replace("number", "number quiet") if quiet else markup)
        rows.append((run, cells))
    table("Standard deviation of the body velocity", heads, rows)
