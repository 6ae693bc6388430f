"""Read the raw exports of one run as a recording."""

from rovsim.dynamics.vehicle import Vehicle, load_vehicle
from rovsim.measurement.campaign import Campaign
from rovsim.measurement.recording import Anomalies, Recording, read_run
from rovsim.simulation.command_columns import mark_angles


def load_campaign_vehicle(campaign: Campaign) -> Vehicle:
    """Load the vehicle that a campaign was recorded with."""
    return load_vehicle(campaign.vehicle, named_in=campaign.file)


def read_recording(campaign: Campaign, run: str) -> tuple[Recording, Anomalies]:
    """Read the raw export of one run, and what was wrong with its files.

    The recording is in NED and FRD; nothing is filtered. Of the vehicle only the columns of its
    commands matter: which of them are angles.

    Raises:
        BadInput: the run cannot be read.
    """
    return read_run(mark_angles(campaign, load_campaign_vehicle(campaign)), run)
