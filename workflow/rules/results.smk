from rovsim.reporting.report_data import list_run_figures, read_by

# What figures and the report show of all runs, by the name that they ask for it.
RESULTS = {
    **{
        name: f"{R}/{name}.json"
        for name in ("comparison", "ladder", "growth", "timing", "where", "diagnosis")
    },
    # only where errors of the same runs have been published
    "published_errors": [f"{R}/published_errors.json"] if folds.published else [],
    "pitfalls": [f"{R}/pitfalls.json"] if folds.pitfalls else [],
    "quality": expand(f"{R}/quality/{{run}}.json", run=study.runs()),
}
FIGURES = [figure.name for figure in folds.figures]


rule compare:
    "Score all models on all runs; write the ladder, the growth of errors and the error conditions."
    input:
        replays=expand(
            f"{R}/replay/{{model}}/{{run}}.npz", model=models.all, run=study.runs()
        ),
        motions=expand(f"{R}/motions/{{run}}.npz", run=study.runs()),
        searches=expand(f"{R}/where/{{model}}.json", model=models.searched),
        diagnosis=f"{R}/diagnosis.json",
    output:
        where=f"{R}/where.json",
        comparison=f"{R}/comparison.json",
        ladder=f"{R}/ladder.json",
        growth=f"{R}/growth.json",
    log:
        f"{R}/logs/compare.log",
    benchmark:
        f"{R}/benchmarks/compare.tsv"
    params:
        code=code_of("compare"),
    script:
        "../scripts/compare.py"


# One rule for each figure, so that each has its own caption and re-runs on its own edits.
for figure in folds.figures:

    rule:
        name:
            f"figure_{figure.name}"
        input:
            **{name: RESULTS[name] for name in read_by(figure) if name in RESULTS},
        output:
            png=report(
                f"{R}/figures/{figure.name}.png",
                caption="../report/figure.rst",
                category="Study",
                labels={"figure": figure.name},
            ),
            pdf=f"{R}/figures/{figure.name}.pdf",
        log:
            f"{R}/logs/figures/{figure.name}.log",
        benchmark:
            f"{R}/benchmarks/figures/{figure.name}.tsv"
        params:
            figure=figure.name,
            caption=figure.caption,
            code=code_of("figure_of_study", f"rovsim.reporting.figures.{figure.name}"),
        script:
            "../scripts/figure_of_study.py"


for figure in list_run_figures():

    rule:
        name:
            f"figure_{figure.name}"
        input:
            motion=f"{R}/motions/{{run}}.npz",
            replays=expand(f"{R}/replay/{{model}}/{{{{run}}}}.npz", model=models.drawn),
            budget=[f"{R}/budget/{{run}}.npz"] if "budget" in figure.needs else [],
        output:
            png=report(
                f"{R}/figures/{figure.name}-{{run}}.png",
                caption="../report/figure.rst",
                category="Runs",
                labels={"figure": figure.name, "run": "{run}"},
            ),
            pdf=f"{R}/figures/{figure.name}-{{run}}.pdf",
        log:
            f"{R}/logs/figures/{figure.name}-{{run}}.log",
        benchmark:
            f"{R}/benchmarks/figures/{figure.name}-{{run}}.tsv"
        params:
            figure=figure.name,
            caption=figure.caption,
            code=code_of("figure_of_run", f"rovsim.reporting.figures.{figure.name}"),
        script:
            "../scripts/figure_of_run.py"


rule tables:
    "Write the tables as LaTeX and CSV."
    input:
        comparison=f"{R}/comparison.json",
        ladder=f"{R}/ladder.json",
    output:
        expand(
            f"{R}/tables/{{table}}.{{kind}}",
            table=["ladder", "velocity_rmse", "velocity_mae", "acceleration_rmse"],
            kind=["tex", "csv"],
        ),
    log:
        f"{R}/logs/tables.log",
    benchmark:
        f"{R}/benchmarks/tables.tsv"
    params:
        code=code_of("tables"),
    script:
        "../scripts/tables.py"


rule report:
    "Write the report of the study, on one page."
    input:
        **RESULTS,
        figures=expand(f"{R}/figures/{{name}}.png", name=[*FIGURES, *study.figures()]),
    output:
        report(f"{R}/report.html", caption="../report/report.rst", category="Study"),
    log:
        f"{R}/logs/report.log",
    benchmark:
        f"{R}/benchmarks/report.tsv"
    params:
        name=study.name,
        given=depends.given(),
        code=code_of("report"),
    script:
        "../scripts/report.py"


rule track:
    "Log the study to MLflow, once everything else is written."
    input:
        comparison=f"{R}/comparison.json",
        ladder=f"{R}/ladder.json",
        diagnosis=f"{R}/diagnosis.json",
        figures=expand(f"{R}/figures/{{name}}.png", name=FIGURES),
        report=f"{R}/report.html",
        models=expand(f"{R}/models/{{model}}/model.yaml", model=models.with_files),
    output:
        f"{R}/tracked.json",
    log:
        f"{R}/logs/track.log",
    benchmark:
        f"{R}/benchmarks/track.tsv"
    params:
        experiment=study.name,
        settings=study.settings.tracking.model_dump_json(),
        diagnosing=depends.plain(DiagnosisSettings),
        code=code_of("track"),
    script:
        "../scripts/track.py"
