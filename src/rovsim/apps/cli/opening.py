"""The campaign of a command, and where it writes."""

from pathlib import Path

from rovsim.application.pipeline.recordings import MeasuredCampaign, measure, open_campaign
from rovsim.application.settings import CampaignSettings
from rovsim.apps.cli.output import choose_folder


def measure_campaign(
    settings: CampaignSettings, what: str, even_unusable: bool = False
) -> tuple[MeasuredCampaign, Path]:
    """The campaign, measured once it is clear that the folder of `what` can be written.

    Raises:
        BadInput: it cannot be read, no run can be used, or the folder holds something else.
    """
    campaign = open_campaign(settings.campaign)
    out = choose_folder(settings, f"results/{campaign.name}/{what}")
    return measure(campaign, settings.signals, even_unusable), out
