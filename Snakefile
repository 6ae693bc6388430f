"""The study, from raw exports to figures: `snakemake --cores 2 [--config campaign=DIR]`."""

import sys
from pathlib import Path

from rovsim.application.study.dependencies import Dependencies
from rovsim.application.study.leave_one_run_out import LeaveOneRunOut
from rovsim.application.study.lock import hold
from rovsim.application.study.models import StudyModels
from rovsim.application.study.study import Study
from rovsim.core.errors import RovsimError

study = Study(config)
models = StudyModels(study)
folds = LeaveOneRunOut(study)
depends = Dependencies(study)
try:
    study.check()
    folds.check()
    # What the jobs are told: also files of effects that the configuration names.
    config["effects_file"] = [str(path) for path in study.catalogue.files]
except RovsimError as error:
    print(f"rovsim: {error}", file=sys.stderr)
    sys.exit(2)


onstart:
    try:
        hold(Path(study.folder))
    except RovsimError as error:
        print(f"rovsim: {error}", file=sys.stderr)
        sys.exit(2)


wildcard_constraints:
    run="[^/]+",
    fold="[^/]+",
    model="[^/]+",
    base="(effects\\+)?",


localrules:
    all,


include: "workflow/rules/common.smk"


rule all:
    default_target: True
    input:
        f"{R}/report.html",
        f"{R}/diagnosis.json",
        f"{R}/comparison.json",
        f"{R}/ladder.json",
        f"{R}/tables/ladder.tex",
        f"{R}/tracked.json",
        folds.targets,


include: "workflow/rules/recordings.smk"
include: "workflow/rules/signals.smk"
include: "workflow/rules/diagnosis.smk"
include: "workflow/rules/replay.smk"
include: "workflow/rules/residuals.smk"
include: "workflow/rules/results.smk"


if folds.runs:

    include: "workflow/rules/folds.smk"
