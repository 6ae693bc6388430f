"""What the workbench leaves to another process: the same work as the commands do."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from rovsim.application.loading import measured, models
from rovsim.application.pipeline import compare, diagnose, train
from rovsim.application.provenance import provenance
from rovsim.application.settings import Settings
from rovsim.core.files import write_json
from rovsim.core.progress import reported
from rovsim.dynamics.catalogue import load_catalogue
from rovsim.reporting.report_data import PER_RUN
from rovsim.simulation.synthetic_tank.campaign import make_campaign

ONCE = (
    "ranking", "ladder", "where", "where_map", "error_by_axis", "error_growth", "excitation"
)  # fmt: skip


def find(settings: Settings, path: Path) -> dict[str, Any]:
    """Diagnose settings.model; writes diagnosis.json to `path` and returns it."""
    catalogue = load_catalogue(settings.effect_files)
    data = measured(settings, even_unusable=True)
    content = diagnose(data, models(settings, data.vehicle, catalogue), settings, catalogue).content
    write_json(path, content)
    return content


def learn(settings: Settings, path: Path) -> Path:
    """Train a residual on top of settings.model; returns the model file, `path`."""
    catalogue = load_catalogue(settings.effect_files)
    data = measured(settings)
    base = models(settings, data.vehicle, catalogue)[0]
    train(data, base, settings, catalogue, path.parent, path.stem)
    return path


def tell(settings: Settings, known: dict[str, Any], out: Path) -> Path:
    """Write comparison.json, where.json, what is `known` by name, and report.html; returns it."""
    from rovsim.reporting.html.folder import present

    catalogue = load_catalogue(settings.effect_files)
    data = measured(settings)
    chosen = models(settings, data.vehicle, catalogue)
    evidence = replace(compare(data, chosen, settings), **known)
    wanted = [(figure, "") for figure in ONCE if figure != "ranking" or "diagnosis" in known]
    tests = [run for run, motion in data.motions.items() if motion.run.split == "test"]
    wanted += [(figure, run) for run in tests for figure in PER_RUN]
    present(out, data.campaign.name, evidence, wanted, provenance(settings), catalogue)
    contents = {"comparison": evidence.comparison, "where": evidence.where, **known}
    for name, content in contents.items():
        write_json(out / f"{name}.json", content)
    return out / "report.html"


def practise(settings: Settings, out: Path) -> Path:
    """Fly a synthetic campaign; returns its folder."""
    catalogue = load_catalogue(settings.effect_files)
    with reported("flying the practice campaign") as progress:
        make_campaign(settings.tank, out, catalogue, progress)
    return out
