"""Read a whole campaign: motions, poses before the filter, and reports on quality."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping

from rovsim.application.pipeline.motion import derive_motion
from rovsim.application.pipeline.quality import judge_recording
from rovsim.application.pipeline.recorded_run import load_campaign_vehicle, read_recording
from rovsim.core.bounded_cache import Remade
from rovsim.core.errors import BadInput
from rovsim.core.progress import counted
from rovsim.dynamics.vehicle import Vehicle
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.loading import load_campaign
from rovsim.measurement.runs import Runs
from rovsim.measurement.signals.chain import SignalSettings, Stage, filtered, resampled
from rovsim.measurement.signals.motion import Motion
from rovsim.results.quality import Quality


@dataclass(frozen=True, eq=False)
class MeasuredCampaign:
    """A campaign as measured.

    Runs beyond what memory should hold are read again when they are asked for.

    Attributes:
        campaign: as its file describes it.
        vehicle: that it was recorded with.
        motions: of usable runs, by run.
        quality: reports, by run, of all runs.
        stages: poses of usable runs before the filter, by run.
    """

    campaign: Campaign
    vehicle: Vehicle
    motions: Mapping[str, Motion]
    quality: dict[str, Quality]
    stages: Mapping[str, Stage]

    @property
    def runs(self) -> Runs:
        """The usable runs, as a diagnosis takes them."""
        splits = {run: self.quality[run].split for run in self.motions}
        return Runs(self.motions, self.stages, splits)


def open_campaign(folder: str | None) -> Campaign:
    """Load the campaign in a folder.

    Raises:
        BadInput: no folder was given, or the campaign cannot be read.
    """
    if folder is None:
        raise BadInput(
            "no campaign was given",
            where="command line",
            expected="campaign=DIR, a folder that holds campaign.yaml",
            remedy="`rovsim tank out=DIR` makes a synthetic one to try.",
        )
    return load_campaign(Path(folder))


def measure(
    campaign: Campaign, settings: SignalSettings, even_unusable: bool = False
) -> MeasuredCampaign:
    """Read, check and clean all usable runs of a campaign.

    Args:
        campaign: to be read.
        settings: of the signal chain.
        even_unusable: whether a campaign without a usable run is returned, too.

    Raises:
        BadInput: the campaign cannot be read, or no run can be used.
    """
    quality: dict[str, Quality] = {}

    def read(run: str) -> Stage:
        return resampled(read_recording(campaign, run)[0], settings)

    def derive(run: str) -> Motion:
        return derive_motion(filtered(stages[run], settings), quality[run], settings)

    stages, motions = Remade((), read), Remade((), derive)
    for run in counted(campaign.runs, "reading"):
        recording, anomalies = read_recording(campaign, run.id)
        quality[run.id] = judge_recording(campaign, recording, anomalies, settings.outliers)
        if quality[run.id].unusable is None:
            stages.keep(run.id, resampled(recording, settings))
            motions.keep(run.id, derive(run.id))
    measured = MeasuredCampaign(campaign, load_campaign_vehicle(campaign), motions, quality, stages)
    if not even_unusable:
        refuse_unusable(measured)
    return measured


def refuse_unusable(data: MeasuredCampaign) -> None:
    """Refuse a campaign without a run that can be used.

    Raises:
        BadInput: there is none; the message says why each run cannot be used.
    """
    if data.motions:
        return
    reasons = "; ".join(f"{run}: {q.unusable}" for run, q in data.quality.items())
    raise BadInput(
        f"no run can be used ({reasons})",
        where=data.campaign.file,
        expected="at least one run that moves and is long enough",
        remedy="Record longer runs in which the vehicle moves.",
    )
