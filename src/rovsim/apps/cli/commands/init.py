"""Look into exported files and write a commented campaign.yaml for them.

rovsim init FILE… out=DIR [force=true]

FILE: exports of QTM or Motive, C3D, ROS 2 bags, ArduPilot logs, csv files, logs of commands, or
folders of them. DIR (default: the folder of the files) gets campaign.yaml; the recordings stay
where they are. What cannot be found out is marked ANSWER, with the possible answers above it; what
is a guess (such as `control`: 3dof where nothing turned, else 6dof) says so; CHECK at the top says
what looks wrong. An existing campaign.yaml is replaced only with force=true.

Then: rovsim compare campaign=DIR, or rovsim ui campaign=DIR
"""

import os
import tempfile
from pathlib import Path
from shlex import quote

from rovsim.application.settings import WritingSettings
from rovsim.apps.cli.output import choose_folder, say
from rovsim.core.errors import BadInput
from rovsim.dynamics.catalogue import Catalogue
from rovsim.intake.compose import propose
from rovsim.intake.guesses import list_guesses, list_taken
from rovsim.intake.proposal import CampaignProposal
from rovsim.intake.write import check_place, write_proposal


class Settings(WritingSettings):
    """What `rovsim init` takes."""

    files: list[str]
    force: bool


def run(settings: Settings, catalogue: Catalogue) -> None:
    """Look, write, and say what was found and what is left to answer."""
    paths = [Path(os.path.expanduser(name)) for name in settings.files]
    if not paths:
        raise BadInput(
            "no file was named",
            where="command line",
            expected="rovsim init FILE… out=DIR",
            remedy="Name the exports, or the folder that they lie in.",
        )
    out = choose_folder(settings, _folder(paths))
    check_place(out, settings.force)
    with tempfile.TemporaryDirectory() as scratch:
        proposal = propose(paths, out, Path(scratch))
        file = write_proposal(proposal, out, settings.force)
    say(settings, _format_proposal(proposal, file), _content(proposal, file))


def _folder(paths: list[Path]) -> str:
    """The folder that all files lie in; a folder of recordings that was named is that itself."""
    folders = {
        str(p.absolute() if p.is_dir() and not _bag(p) else p.absolute().parent) for p in paths
    }
    return os.path.commonpath(sorted(folders))


def _bag(path: Path) -> bool:
    return (path / "metadata.yaml").is_file()


def _format_proposal(proposal: CampaignProposal, file: Path) -> str:
    parts = ["\n".join(f"  {line}" for line in proposal.findings)]
    assumptions = [*list_taken(proposal), *(f"guess: {line}" for line in list_guesses(proposal))]
    parts.append("\n".join(f"  {line}" for line in assumptions))
    if proposal.checks:
        parts.append("\n".join(f"CHECK  {line}" for line in proposal.checks))
    if proposal.questions:
        questions = [
            f"  {q.place}: {q.asks} {', '.join(v for v, _ in q.answers)}"
            for q in proposal.questions
        ]
        parts.append(f"{len(questions)} to be answered in {file}:\n" + "\n".join(questions))
    first = "Answer these in it. " if proposal.questions else ""
    parts.append(f"{file}\n{first}Then: rovsim compare {quote(f'campaign={file.parent}')}")
    return "\n\n".join(parts)


def _content(proposal: CampaignProposal, file: Path) -> dict:
    return {
        "campaign": str(file),
        "found": proposal.findings,
        "taken": list_taken(proposal),
        "guesses": list_guesses(proposal),
        "checks": proposal.checks,
        "questions": [
            {"key": q.place, "asks": q.asks, "answers": [v for v, _ in q.answers]}
            for q in proposal.questions
        ],
    }
