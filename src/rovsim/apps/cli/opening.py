"""Open the campaign of a command, and choose the folder that it writes to."""

from pathlib import Path

from rovsim.application.pipeline.measured_campaign import MeasuredCampaign, measure, open_campaign
from rovsim.application.settings import CampaignSettings
from rovsim.apps.cli.output import choose_folder


def measure_campaign(
    settings: CampaignSettings, what: str, even_unusable: bool = False
) -> tuple[MeasuredCampaign, Path]:
    """Measure the campaign of a command, after a check that its results can be written.

    Args:
        settings: with the campaign, and the folder of results if one is given.
        what: last part of the default folder, results/CAMPAIGN/`what`.
        even_unusable: whether it is enough that runs exist, even if none of them can be used.

    Returns:
        The campaign as measured, and the folder.

    Raises:
        BadInput: the campaign cannot be read, no run can be used, or the folder cannot be written.
    """
    campaign = open_campaign(settings.campaign)
    out = choose_folder(settings, f"results/{campaign.name}/{what}")
    return measure(campaign, settings.signals, even_unusable), out
