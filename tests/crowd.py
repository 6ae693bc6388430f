"""Two studies, two sweeps and a workbench at once, in one folder, on one MLflow database.

python tests/crowd.py      (`make crowd`)

What each writes must be what it writes alone, and every run must be in the database, finished.
"""

import sqlite3
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

from chromium import started
from kills import ROVSIM, WORKS, digests, end, start
from small_study import SMALL

STUDIES = ("one", "two")
SWEEPS = ("5,9", "7,15")


def commands() -> dict[str, list[str]]:
    """What is done, by name."""
    *study, _ = WORKS["study"]
    found = {name: [*study, f"overrides={SMALL} tank.name={name}"] for name in STUDIES}
    for k, values in enumerate(SWEEPS):
        words = [
            "campaign=raw",
            "residual=knn",
            f"residual.k={values}",
            f"hydra.sweep.dir=results/sweep-{k}",
        ]
        found[f"sweep-{k}"] = [*ROVSIM, "train", "-m", *words]
    return found


def prepared(folder: Path) -> Path:
    """A folder with a campaign."""
    folder.mkdir()
    subprocess.run([*ROVSIM, "tank", "tank=tiny", "out=raw", "--quiet"], cwd=folder, check=True)
    return folder


def states(folder: Path) -> Counter[str]:
    """How many runs of the database are in which state."""
    with sqlite3.connect(folder / "results" / "mlflow.db") as base:
        return Counter(state for (state,) in base.execute("SELECT status FROM runs"))


def run(scratch: Path) -> None:
    """First one after the other, then all at once."""
    alone, crowd = (prepared(scratch / name) for name in ("alone", "crowd"))
    for name, command in commands().items():
        end(start(command, alone, f"{name}.txt"), alone / f"{name}.txt")
    workbench, _ = started(crowd, "campaign=raw")
    at_once = {name: start(command, crowd, f"{name}.txt") for name, command in commands().items()}
    for name, process in at_once.items():
        end(process, crowd / f"{name}.txt")
    assert workbench.poll() is None
    workbench.terminate()
    wanted, found = digests(alone), digests(crowd)
    # Times are in some files, and differ: those that tell nothing but results must not.
    compared = [
        n for n in wanted if n.endswith(("diagnosis.json", "comparison.json", "ladder.json"))
    ]
    differ = [name for name in compared if wanted[name] != found.get(name)]
    print(
        f"{len(compared)} result files, {len(differ)} differ {differ}; runs kept: {states(crowd)}"
    )
    assert compared
    assert not differ
    assert states(crowd) == states(alone)
    assert set(states(crowd)) == {"FINISHED"}


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        run(Path(place))
