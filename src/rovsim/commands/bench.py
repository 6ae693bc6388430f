"""Measure replay and inference speed on this machine.

rovsim bench [out=results] [timing.calls=10000] [timing.seconds=10]

Writes results/bench.json. The data are residual features of the default tank campaign.
"""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from rovsim import bench
from rovsim.config import Settings
from rovsim.files import write_json
from rovsim.loading import measured
from rovsim.model import nominal
from rovsim.saying import say
from rovsim.tank.campaign import make_campaign
from rovsim.training import samples


def run(settings: Settings) -> None:
    """Record the default campaign, train on its train runs, time on its test runs."""
    with TemporaryDirectory() as folder:
        make_campaign(settings.tank, Path(folder, "raw"))
        data = measured(settings.model_copy(update={"campaign": str(Path(folder, "raw"))}))
    model = nominal(data.vehicle)
    found = {
        split: [
            samples(model, m, settings.signals, settings.replay)
            for m in data.motions.values()
            if m.run.split == split
        ]
        for split in ("train", "test")
    }
    features = settings.learner.features
    X = np.concatenate([s.features(features) for s in found["train"]])
    Y = np.concatenate([s.a_res for s in found["train"]])
    queries = np.concatenate([s.features(features) for s in found["test"]])
    order = np.random.default_rng(settings.seed).permutation(len(X))
    X, Y = X[order], Y[order]
    content: dict[str, Any] = {
        "schema": "rovsim.bench/1",
        "machine": bench.machine(),
        "replay": bench.replay_speeds(model, X, Y),
        "inference": bench.inference(X, Y, queries, settings.timing.calls, settings.timing.seconds),
    }
    path = Path(settings.out or "results") / "bench.json"
    write_json(path, content)
    rows = [f"{name:<26} {value:14,.0f}" for name, value in content["replay"].items()]
    rows += [
        f"{name:<26} {stats['median_us']:10.1f} us median {stats['p999_us']:10.1f} us p99.9"
        for name, stats in content["inference"].items()
    ]
    say(settings, "\n".join([*rows, str(path)]), content)
