"""Raw exports in, recordings and quality reports out."""

from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.quality import report_quality
from rovsim.measurement.recording import read_run
from rovsim.measurement.recording.recording import Recording
from rovsim.measurement.signals.outliers import Outliers
from rovsim.results.quality import Quality
from rovsim.simulation.command_columns import mark_angles


def load_campaign_vehicle(campaign: Campaign) -> Vehicle:
    """The vehicle a campaign was recorded with."""
    return load_vehicle(campaign.vehicle, beside=campaign.file.parent)


def read_recording(campaign: Campaign, run: str, outliers: Outliers) -> tuple[Recording, Quality]:
    """One raw export in NED and FRD, nothing filtered, and its quality report.

    Raises:
        BadInput: it cannot be read.
    """
    known = mark_angles(campaign, load_campaign_vehicle(campaign))
    recording, anomalies = read_run(known, run)
    return recording, report_quality(recording, anomalies, outliers)
