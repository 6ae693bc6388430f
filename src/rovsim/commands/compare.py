"""Replay every run with every model and measure the errors.

rovsim compare campaign=DIR model=[nominal,FILE,…] out=OUT

Writes OUT/comparison.json (errors per model, run, axis and horizon), figures and OUT/report.html.
"""

from pathlib import Path

from rovsim.config import Settings
from rovsim.evidence import PER_RUN, Evidence, about, arguments
from rovsim.files import write_json
from rovsim.loading import measured, models
from rovsim.progress import counted
from rovsim.provenance import provenance
from rovsim.replay import replay
from rovsim.scores import comparison, growth, score


def run(settings: Settings) -> None:
    """Compare, then write numbers, figures and the report."""
    data = measured(settings)
    chosen = models(settings, data.vehicle)
    out = Path(settings.out or f"results/{data.campaign.name}/compare")
    replays: dict[str, dict] = {model.name: {} for model in chosen}
    jobs = [(model, motion) for model in chosen for motion in data.motions.values()]
    for model, motion in counted(jobs, "replaying"):
        replays[model.name][motion.run.id] = replay(
            model, motion, settings.signals, settings.replay
        )
    motions = list(data.motions.values())
    scores = [score(motion, replays[name][motion.run.id]) for name in replays for motion in motions]
    curves = {name: growth(motions, list(runs.values())) for name, runs in replays.items()}
    evidence = Evidence(
        data.motions, replays, comparison(scores), {"models": curves}, quality=data.quality
    )
    _present(out, data.campaign.name, evidence, settings)
    write_json(out / "comparison.json", evidence.comparison)
    print(f"{out / 'comparison.json'} and {out / 'report.html'}")


def _present(out: Path, name: str, evidence: Evidence, settings: Settings) -> None:
    from rovsim.figures import kind
    from rovsim.figures.style import save
    from rovsim.report import page

    names = list(evidence.replays)
    wanted = [(figure, "") for figure in ("error_by_axis", "error_growth", "excitation")]
    wanted += [(figure, run) for run in evidence.motions for figure in PER_RUN]
    pictures = []
    for figure, one in counted(wanted, "drawing"):
        drawn = kind(figure).draw(**arguments(figure, evidence, one, names))
        stem = f"{figure}-{one}" if one else figure
        save(drawn, out / "figures", stem)
        path = out / "figures" / f"{stem}.png"
        pictures.append(page.Picture.read(path, figure, about(figure, one)))
    inputs = page.ReportInputs(
        name, evidence.comparison, quality=evidence.quality, pictures=pictures,
        provenance=provenance(settings),
    )  # fmt: skip
    page.write(out / "report.html", inputs)
