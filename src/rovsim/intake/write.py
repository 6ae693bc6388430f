"""Write a proposal as campaign.yaml, and the copies of recordings that it needs."""

from pathlib import Path

from rovsim.core.errors import BadInput
from rovsim.core.files import copy_file, write_text
from rovsim.intake.proposal import CampaignProposal
from rovsim.intake.yaml_file import as_yaml

CAMPAIGN_FILE = "campaign.yaml"


def check_place(out: Path, force: bool = False) -> None:
    """Make sure that nothing is overwritten.

    Raises:
        BadInput: `out` has a campaign.yaml and `force` is false, or is not a folder.
    """
    file = out / CAMPAIGN_FILE
    if out.exists() and not out.is_dir():
        raise BadInput(
            "is not a folder", where=out, expected="a folder", remedy="Give another out=."
        )
    if file.exists() and not force:
        raise BadInput(
            "there is one already",
            where=file,
            expected="a folder without campaign.yaml",
            remedy="Give another out=, move that file away, or replace it with force=true.",
        )


def write_proposal(proposal: CampaignProposal, out: Path, force: bool = False) -> Path:
    """Write campaign.yaml and copies into the folder `out`, which is made if it is missing.

    Args:
        proposal: what is written.
        out: the folder.
        force: whether a campaign.yaml that is there is replaced.

    Returns:
        The path of campaign.yaml.

    Raises:
        BadInput: there is one already, or it cannot be written.
    """
    check_place(out, force)
    for place, name in proposal.copies.items():
        copy_file(place, out / name)
    write_text(out / CAMPAIGN_FILE, as_yaml(proposal))
    return out / CAMPAIGN_FILE
