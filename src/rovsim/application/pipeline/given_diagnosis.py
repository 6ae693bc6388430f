"""Read a diagnosis file that a user gives, if it is of the open campaign's recordings."""

from pathlib import Path
from typing import Mapping

from rovsim.application.provenance import digest_recordings
from rovsim.core.errors import BadInput
from rovsim.measurement.campaign import Campaign
from rovsim.reporting.wording import several
from rovsim.results.diagnosis import Diagnosis


def read_given_diagnosis(path: Path, campaign: Campaign) -> Diagnosis:
    """Read a diagnosis, and check that it is of the recordings of a campaign.

    Recordings are compared by content, not by name or folder. Diagnoses of earlier versions do not
    say which recordings they are of, and are not checked.

    Raises:
        BadInput: the file is missing or damaged, or it is a diagnosis of other recordings.
    """
    diagnosis = Diagnosis.read(path)
    if diagnosis.recordings:
        _refuse_other(path, diagnosis.recordings, campaign)
    return diagnosis


def _refuse_other(path: Path, diagnosed: Mapping[str, str], campaign: Campaign) -> None:
    digests = digest_recordings(campaign)
    absent = [name for name, content in diagnosed.items() if content not in digests.values()]
    new = [name for name, content in digests.items() if content not in diagnosed.values()]
    if len(absent) == len(diagnosed):
        problem = (
            f"is a diagnosis of other recordings: none of the {len(absent)} files that it read "
        )
        problem += "is in this campaign"
    elif absent:
        detail = (
            f"{len(absent)} of the {len(diagnosed)} files that it read are not in this campaign"
        )
        problem = f"is a diagnosis of other recordings: {detail} ({several(absent)})"
    elif new:
        detail = f"it did not read {len(new)} of the {len(digests)} files of this campaign"
        problem = f"is a diagnosis of fewer recordings: {detail} ({several(new)})"
    else:
        return
    raise BadInput(
        problem,
        where=path,
        expected=f"a diagnosis of the recordings of '{campaign.name}' in {campaign.folder}",
        remedy="Open the campaign that was diagnosed; or leave `diagnosis=` out, and the workbench "
        "diagnoses this one.",
    )
