"""Judge the quality of a recording, by itself and beside its vehicle and the other runs."""

from rovsim.application.pipeline.recorded_run import load_campaign_vehicle
from rovsim.dynamics.vehicle.implausible_numbers import doubt_units
from rovsim.evaluation.commanded_motion.doubts import find_doubts
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.quality.assessment import report_quality
from rovsim.measurement.quality.copied_runs import doubt_copy, list_same_log
from rovsim.measurement.recording import Anomalies, Recording
from rovsim.measurement.signals.outliers import Outliers
from rovsim.results.quality import Quality


def judge_recording(
    campaign: Campaign, recording: Recording, anomalies: Anomalies, outliers: Outliers
) -> Quality:
    """Report on the quality of a recording.

    For one that can be used, the report also tells of numbers of the vehicle file that may be in
    another unit, of a motion that does not go with its commands, and of train runs that a test run
    copies.

    Args:
        campaign: that the run belongs to.
        recording: as it was read.
        anomalies: what was wrong with its files.
        outliers: how outliers are found; they are counted.
    """
    quality = report_quality(recording, anomalies, outliers)
    if quality.unusable is not None:
        return quality
    vehicle = load_campaign_vehicle(campaign)
    run = campaign.run(recording.run.id)
    doubts = find_doubts(recording, vehicle, list_same_log(campaign, run))
    return quality.doubted(*doubt_units(vehicle), *doubts, *doubt_copy(campaign, run))
