"""Read the raw exports of one run as a recording, and report on its quality."""

from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.dynamics.vehicle.units import doubt_units
from rovsim.evaluation.commanded_motion.doubts import find_doubts
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.quality.assessment import report_quality
from rovsim.measurement.quality.copied_runs import doubt_copy
from rovsim.measurement.recording import Anomalies, Recording, read_run
from rovsim.measurement.signals.outliers import Outliers
from rovsim.results.quality import Quality
from rovsim.simulation.command_columns import mark_angles


def load_campaign_vehicle(campaign: Campaign) -> Vehicle:
    """Load the vehicle that a campaign was recorded with."""
    return load_vehicle(campaign.vehicle, named_in=campaign.file)


def read_recording(campaign: Campaign, run: str) -> tuple[Recording, Anomalies]:
    """Read the raw export of one run, and what was wrong with its files.

    The recording is in NED and FRD; nothing is filtered.

    Raises:
        BadInput: the run cannot be read.
    """
    return read_run(mark_angles(campaign, load_campaign_vehicle(campaign)), run)


def judge_recording(
    campaign: Campaign, recording: Recording, anomalies: Anomalies, outliers: Outliers
) -> Quality:
    """Report on the quality of a recording.

    For one that can be used, the report also tells of numbers of the vehicle file that may be in
    another unit, of a motion that does not go with its commands, and of train runs that a test run
    copies.
    """
    quality = report_quality(recording, anomalies, outliers)
    if quality.unusable is not None:
        return quality
    vehicle = load_campaign_vehicle(campaign)
    copies = doubt_copy(campaign, campaign.run(recording.run.id))
    return quality.doubted(*doubt_units(vehicle), *find_doubts(recording, vehicle), *copies)
