"""Measure replay and inference speed on this machine, beside the libraries' own.

rovsim bench [out=results] [bench.calls=100000] [bench.seconds=60] [bench.sweep_seconds=2]

Writes results/bench.json, and its table and plots into the page bench.page, if it is there. The
data are residual features of the default campaign, flown for bench.duration s a run. Needs the
extra rovsim[benchmark]. Interrupted, it leaves bench.unfinished.json with what was timed by then:
times of two calls are not mixed, so that the next begins anew.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from rovsim.application.pipeline.measured_campaign import measure
from rovsim.application.sections import SimulationSections
from rovsim.application.settings import BenchSettings, WritingSettings
from rovsim.apps.cli.output import say
from rovsim.benchmarks.speed.accuracy import measure_accuracy
from rovsim.benchmarks.speed.data import Pairs, fitted, unfading
from rovsim.benchmarks.speed.inference import GP_SETTINGS, Effort, inference
from rovsim.benchmarks.speed.replay import replay_speeds
from rovsim.benchmarks.speed.tables import write_page
from rovsim.core.extras import require
from rovsim.core.making import describe_machine
from rovsim.dynamics.catalogue import Catalogue
from rovsim.dynamics.learned.settings import FeatureSettings
from rovsim.dynamics.model import Model, nominal
from rovsim.measurement.loading import load_campaign
from rovsim.results.timing import Bench, Latency
from rovsim.simulation.samples import sample_run
from rovsim.simulation.synthetic_tank.campaign import make_campaign
from rovsim.simulation.synthetic_tank.settings import TankSettings

UNFINISHED_FILE = "bench.unfinished.json"  # as far as it is, beside the result
LARGE_FEATURES = FeatureSettings(blocks=("velocity", "wrench", "acceleration"))  # 18 features


class Settings(SimulationSections, WritingSettings):
    """What `rovsim bench` takes."""

    tank: TankSettings
    bench: BenchSettings


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Record the campaign, train on its train runs, time on its test runs."""
    require("benchmark", "learn", by="rovsim bench")
    model, samples = _samples(settings, catalogue)
    options = settings.bench
    pairs = _pairs(samples, FeatureSettings()).drawn()
    large = _pairs(samples, LARGE_FEATURES).drawn()
    gp = fitted("gp", pairs.first(2_000), max_points=2_000, **GP_SETTINGS)
    knn = fitted("knn", large.first(2_235), features=LARGE_FEATURES)  # the thesis' size
    residuals = {"knn": knn, "gp": unfading(gp), "gp_faded": gp}
    effort = Effort(options.calls, options.warmup, options.seconds)
    speeds = replay_speeds(model, residuals)
    path = Path(settings.out or "results") / "bench.json"
    result = Bench(
        machine=describe_machine(), replay=speeds, inference={}, scheduling="", accuracy=()
    )
    unfinished = path.with_name(UNFINISHED_FILE)

    def known_with(timed: dict[str, Latency], scheduling: str) -> Bench:
        return result.model_copy(update={"inference": timed, "scheduling": scheduling})

    def keep(timed: dict[str, Latency], scheduling: str) -> None:
        known_with(timed, scheduling).write(unfinished)

    timed = known_with(*inference(pairs, effort, options.sweep_seconds, keep))
    bench = timed.model_copy(update={"accuracy": measure_accuracy(pairs)})
    bench.write(path)
    unfinished.unlink(missing_ok=True)
    write_page(Path(options.page), bench)
    say(settings, str(path), bench.to_json())


def _samples(settings: Settings, catalogue: Catalogue) -> tuple[Model, dict[str, list]]:
    """Samples of the train and of the test runs, with the control of each."""
    tank = settings.tank.model_copy(update={"duration": settings.bench.duration})
    with TemporaryDirectory() as folder:
        make_campaign(tank, Path(folder, "raw"), catalogue)
        data = measure(load_campaign(Path(folder, "raw")), settings.signals)
    model = nominal(data.vehicle)
    by_split: dict[str, list] = {"train": [], "test": []}
    for motion in data.motions.values():
        samples = sample_run(model, motion, settings)
        by_split[motion.run.split].append((motion.run.control, samples))
    return model, by_split


def _pairs(samples: dict[str, list], features: FeatureSettings) -> Pairs:
    def joined(split: str) -> tuple:
        runs = samples[split]
        return (
            np.concatenate([s.features(features) for _, s in runs]),
            np.concatenate([s.a_res for _, s in runs]),
            np.concatenate([np.full(len(s.index), control) for control, s in runs]),
        )

    return Pairs(*joined("train"), *joined("test"))
