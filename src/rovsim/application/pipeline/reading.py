"""Raw exports in, recordings and quality reports out."""

from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.evaluation.commanded_motion.doubts import find_doubts
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.held_out import doubt_test_run
from rovsim.measurement.quality import report_quality
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
    quality = report_quality(recording, anomalies, outliers)
    if quality.unusable is None:
        repeats = doubt_test_run(campaign, campaign.run(run))
        quality = quality.doubted(*find_doubts(recording, vehicle), *repeats)
    return recording, quality
