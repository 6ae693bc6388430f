"""The speed benchmark: all ways predict the same, and the page shows what was found."""

from importlib import import_module

import numpy as np
import pytest

from rovsim.application.configuration import compose
from rovsim.apps.cli.dispatch import run_command
from rovsim.benchmarks.speed.accuracy import measure_left
from rovsim.benchmarks.speed.data import Pairs, fitted, unfading
from rovsim.benchmarks.speed.inference import Effort, Stopwatch, time_neighbours, time_processes
from rovsim.benchmarks.speed.tables import write_markdown, write_page
from rovsim.reporting.pages.marked import BEGIN, END
from rovsim.results.timing import Bench

FEW = Effort(calls=5, warmup=1, seconds=0.05)


def pairs(rows=150, asked=20):
    rng = np.random.default_rng(0)
    X, queries = rng.normal(size=(rows, 12)), rng.normal(size=(asked, 12))
    kinds = np.array(["3dof", "6dof"])
    return Pairs(
        X,
        np.tanh(X[:, :6]),
        kinds[np.arange(rows) % 2],
        queries,
        np.tanh(queries[:, :6]),
        kinds[np.arange(asked) % 2],
    )


@pytest.fixture(scope="module")
def found():
    stopwatch = Stopwatch(pairs(), FEW)
    with pytest.MonkeyPatch.context() as patch:
        patch.delattr("os.setpriority")  # tests do not push other programs aside
        time_neighbours(stopwatch, 150, 0.05)
        time_processes(stopwatch, 150, 0.05)
    return stopwatch.latencies


def test_what_was_timed_is_told_before_the_next_way_is(monkeypatch):
    monkeypatch.delattr("os.setpriority")
    told = []
    stopwatch = Stopwatch(pairs(), FEW, lambda timed, scheduling: told.append([*timed]))
    for name in ("one", "other"):
        stopwatch.time(name, lambda x: x, 1, 0.01)
    assert told == [["one@1"], ["one@1", "other@1"]]


def test_an_interrupted_benchmark_keeps_what_was_timed(tmp_path, monkeypatch):
    def interrupted(drawn, effort, seconds, tell):
        stopwatch = Stopwatch(drawn, FEW, tell)
        stopwatch.time("one", lambda x: x, 1, 0.01)
        raise KeyboardInterrupt

    monkeypatch.delattr("os.setpriority")
    bench = import_module("rovsim.apps.cli.commands.bench")
    monkeypatch.setattr(bench, "inference", interrupted)
    monkeypatch.setattr(bench, "replay_speeds", lambda *_: {"single_steps_per_s": 2e6})
    words = ["command=bench", "tank=tiny", "bench.duration=5", f"out='{tmp_path}'"]
    with pytest.raises(KeyboardInterrupt):
        run_command(compose(words))
    (kept,) = tmp_path.iterdir()
    assert kept.name == "bench.unfinished.json"
    assert [*Bench.read(kept).inference] == ["one@1"]


def test_all_ways_predict_the_same(found):
    gaps = {
        f"{name} {other}": gap
        for name, stats in found.items()
        for other, gap in stats.largest_difference.items()
        if other != "gpytorch_love"  # an approximation
    }
    assert len(gaps) == 7
    assert max(gaps.values()) < 1e-6, gaps


def test_the_page_shows_the_results(found, tmp_path):
    row = {"points": 5, "median_us": 2.0, "seen": {"mean": 0.5, "worst": 0.6}}
    row |= {"unseen": {"mean": 0.9, "worst": 1.1}}
    bench = Bench(
        machine="M",
        scheduling="S",
        replay={"single_steps_per_s": 2e6},
        inference=found,
        accuracy=[row | {"name": "gp", "fades": fades} for fades in (False, True)],
    )
    page = tmp_path / "page.md"
    page.write_text(f"before\n{BEGIN}\n{END}\nafter\n", encoding="utf-8")
    write_page(page, bench)
    assert page.read_text(encoding="utf-8").startswith("before")
    assert "| single | 2,000,000 |" in write_markdown(bench)
    assert "| sklearn_knn | 150 |" in write_markdown(bench)
    names = sorted(path.name for path in (tmp_path / "images").iterdir())
    assert names == ["bench_accuracy.png", "bench_sizes.png"]


def test_what_is_left_is_measured_where_it_was_asked():
    knn = fitted("knn", pairs().of("3dof"))
    left = measure_left(knn, pairs(), "6dof")
    assert 0.0 < left.mean <= left.worst


def test_a_process_can_be_asked_not_to_fade():
    gp = fitted("gp", pairs(60), max_points=60, iterations=3)
    far = 50.0 * np.ones((1, 12))
    assert (gp.predict(far) == 0.0).all()
    assert unfading(gp).predict(far) == pytest.approx(gp.posterior(far)[0])
