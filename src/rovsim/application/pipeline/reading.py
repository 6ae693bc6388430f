"""Raw exports in, recordings and quality reports out."""

from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.evaluation.commanded_motion.doubts import find_doubts
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.held_out import doubt_test_run
from rovsim.measurement.quality import report_quality, usable_reason
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.outliers import Outliers
from rovsim.results.quality import Quality
from rovsim.simulation.command_columns import mark_angles


def load_campaign_vehicle(campaign: Campaign) -> Vehicle:
    """The vehicle a campaign was recorded with."""
    return load_vehicle(campaign.vehicle, named_in=campaign.file)


def read_recording(campaign: Campaign, run: str, outliers: Outliers) -> tuple[Recording, Quality]:
    """One raw export in NED and FRD, nothing filtered, and its quality report.

    Raises:
        BadInput: it cannot be read.
    """
    vehicle = load_campaign_vehicle(campaign)
    known = mark_angles(campaign, vehicle)
    recording, anomalies = read_run(known, run)
    doubts: list[str] = []
    if usable_reason(recording) is None:
        doubts += [*find_doubts(recording, vehicle), *doubt_test_run(campaign, campaign.run(run))]
    return recording, report_quality(recording, anomalies, outliers, doubts)
