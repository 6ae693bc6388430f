"""Raw exports in, recordings out; then what speaks for and against them."""

from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.dynamics.vehicle.units import doubt_units
from rovsim.evaluation.commanded_motion.doubts import find_doubts
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.held_out import doubt_test_run
from rovsim.measurement.quality import report_quality
from rovsim.measurement.recording import Anomalies, Recording, read_run
from rovsim.measurement.signals.outliers import Outliers
from rovsim.results.quality import Quality
from rovsim.simulation.command_columns import mark_angles


def load_campaign_vehicle(campaign: Campaign) -> Vehicle:
    """The vehicle a campaign was recorded with."""
    return load_vehicle(campaign.vehicle, named_in=campaign.file)


def read_recording(campaign: Campaign, run: str) -> tuple[Recording, Anomalies]:
    """One raw export in NED and FRD, nothing filtered, and what was wrong with its files.

    Raises:
        BadInput: it cannot be read.
    """
    return read_run(mark_angles(campaign, load_campaign_vehicle(campaign)), run)


def judge_recording(
    campaign: Campaign, recording: Recording, anomalies: Anomalies, outliers: Outliers
) -> Quality:
    """How good a recording is; of one that can be used also what speaks against its campaign."""
    quality = report_quality(recording, anomalies, outliers)
    if quality.unusable is not None:
        return quality
    vehicle = load_campaign_vehicle(campaign)
    repeats = doubt_test_run(campaign, campaign.run(recording.run.id))
    return quality.doubted(*doubt_units(vehicle), *find_doubts(recording, vehicle), *repeats)
