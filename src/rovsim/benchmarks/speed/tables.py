"""The table and plots of docs/benchmark_speed.md."""

from pathlib import Path
from typing import Mapping, Sequence

from rovsim.benchmarks.speed.plots import draw_accuracy, draw_sizes
from rovsim.reporting.figures.style import save
from rovsim.reporting.pages.marked import replace_tables, table
from rovsim.reporting.wording import significant
from rovsim.results.timing import Accuracy, Bench, Latency

PLOT_CAPTIONS = {
    "bench_sizes": "Median and 99.9th percentile of one prediction against the number of points.",
    "bench_accuracy": "Error left against cost, where it was taught and where it was not.",
}


def write_page(path: Path, bench: Bench) -> None:
    """Put the results between the marks of a page, and the plots into images/ beside it.

    Nothing is written where the page does not exist, as outside of a checkout.
    """
    if not path.is_file():
        return
    for name, draw in (("bench_sizes", draw_sizes), ("bench_accuracy", draw_accuracy)):
        for file in save(draw(bench), path.parent / "images", name):
            if file.suffix == ".pdf":
                file.unlink()
    replace_tables(path, write_markdown(bench))


def write_markdown(bench: Bench) -> str:
    """Write `bench.json` as Markdown."""
    plots = [f"![{caption}](images/{name}.png)" for name, caption in PLOT_CAPTIONS.items()]
    parts = [
        f"{bench.machine}; {bench.scheduling}.",
        "### Replay",
        _replay(bench.replay),
        "### One prediction",
        _inference(bench.inference),
        "### By size",
        plots[0],
        "### Error against cost",
        plots[1],
        _accuracy(bench.accuracy),
    ]
    return "\n\n".join(parts)


def _replay(replay: Mapping[str, float]) -> str:
    rows = [
        [name.removesuffix("_steps_per_s").replace("_", " "), f"{value:,.0f}"]
        for name, value in replay.items()
    ]
    return table(["replay", "RK4 steps a second"], rows)


def _inference(inference: Mapping[str, Latency]) -> str:
    head = ["predictor", "points", "calls", "median µs", "p99", "p99.9", "max",
            "late at 1 kHz", "times slower than ours", "largest difference from ours"]  # fmt: skip
    ratios = _by_library({key: stats.times_faster for key, stats in inference.items()})
    gaps = _by_library({key: stats.largest_difference for key, stats in inference.items()})
    rows = []
    for key, stats in inference.items():
        name, points = key.split("@")
        times = [
            significant(time, 3)
            for time in (stats.median_us, stats.p99_us, stats.p999_us, stats.max_us)
        ]
        ratio = significant(ratios[key], 2) if key in ratios else ""
        gap = f"{gaps[key]:.1e}" if key in gaps else ""
        late = str(stats.misses["1000"])
        rows.append([name, points, str(stats.calls), *times, late, ratio, gap])
    return table(head, rows)


def _by_library(numbers: Mapping[str, Mapping[str, float]]) -> dict[str, float]:
    """Return a number that our entries have for each library, by the library's `name@points`."""
    return {
        f"{other}@{key.split('@')[1]}": value
        for key, others in numbers.items()
        for other, value in others.items()
    }


def _accuracy(rows: Sequence[Accuracy]) -> str:
    head = ["residual", "points", "fades", "median µs", "left, seen", "left, unseen",
            "worst axis, unseen"]  # fmt: skip
    lines = [
        [
            row.name,
            str(row.points),
            "yes" if row.fades else "no",
            significant(row.median_us, 2),
            f"{row.seen.mean:.3f}",
            f"{row.unseen.mean:.3f}",
            f"{row.unseen.worst:.3f}",
        ]
        for row in rows
    ]
    return table(head, lines)
