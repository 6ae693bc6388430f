"""The table and plots of docs/benchmark_speed.md."""

from pathlib import Path
from typing import Any, Mapping

from rovsim.benchmarks.speed.plots import draw_accuracy, draw_sizes
from rovsim.reporting.figures.marks import significant
from rovsim.reporting.figures.style import save
from rovsim.reporting.html.marked import replace_tables, table

PLOTS = {
    "bench_sizes": "Median and 99.9th percentile of one prediction against the number of points.",
    "bench_accuracy": "Error left against cost, where it was taught and where it was not.",
}


def write_page(path: Path, content: Mapping[str, Any]) -> None:
    """Put the results between the marks of a page, and the plots into images/ beside it."""
    for name, draw in (("bench_sizes", draw_sizes), ("bench_accuracy", draw_accuracy)):
        for file in save(draw(content), path.parent / "images", name):
            if file.suffix == ".pdf":
                file.unlink()
    replace_tables(path, text(content))


def text(content: Mapping[str, Any]) -> str:
    """Markdown of `bench.json`."""
    plots = [f"![{caption}](images/{name}.png)" for name, caption in PLOTS.items()]
    parts = [
        f"{content['machine']}; {content['scheduling']}.",
        "### Replay", _replay(content["replay"]),
        "### One prediction", _inference(content["inference"]),
        "### By size", plots[0],
        "### Error against cost", plots[1], _accuracy(content["accuracy"]),
    ]  # fmt: skip
    return "\n\n".join(parts)


def _replay(replay: Mapping[str, float]) -> str:
    rows = [
        [name.removesuffix("_steps_per_s").replace("_", " "), f"{value:,.0f}"]
        for name, value in replay.items()
    ]
    return table(["replay", "RK4 steps a second"], rows)


def _inference(inference: Mapping[str, Any]) -> str:
    head = ["predictor", "points", "calls", "median µs", "p99", "p99.9", "max",
            "late at 1 kHz", "times slower than ours", "largest difference from ours"]  # fmt: skip
    ratios, gaps = _against(inference, "times_faster"), _against(inference, "largest_difference")
    rows = []
    for key, stats in inference.items():
        name, points = key.split("@")
        times = [significant(stats[f"{p}_us"], 3) for p in ("median", "p99", "p999", "max")]
        ratio = significant(ratios[key], 2) if key in ratios else ""
        gap = f"{gaps[key]:.1e}" if key in gaps else ""
        late = str(stats["misses"]["1000"])
        rows.append([name, points, str(stats["calls"]), *times, late, ratio, gap])
    return table(head, rows)


def _against(inference: Mapping[str, Any], what: str) -> dict[str, float]:
    """What our entries say of the libraries', by the libraries' entry."""
    return {
        f"{other}@{key.split('@')[1]}": value
        for key, stats in inference.items()
        for other, value in stats.get(what, {}).items()
    }


def _accuracy(rows: list[Mapping[str, Any]]) -> str:
    head = ["residual", "points", "fades", "median µs", "left, seen", "left, unseen",
            "worst axis, unseen"]  # fmt: skip
    lines = [
        [row["name"], str(row["points"]), "yes" if row["fades"] else "no",
         significant(row["median_us"], 2), f"{row['seen']['mean']:.3f}",
         f"{row['unseen']['mean']:.3f}", f"{row['unseen']['worst']:.3f}"]
        for row in rows
    ]  # fmt: skip
    return table(head, lines)
