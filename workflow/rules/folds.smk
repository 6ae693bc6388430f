rule split:
    "Copy all runs, with one of them held out as the only test run of its fold."
    input:
        **clean_runs(),
    output:
        **fold_runs(),
    log:
        f"{F}/logs/split.log",
    benchmark:
        f"{F}/benchmarks/split.tsv"
    params:
        code=code_of("split"),
    script:
        "../scripts/split.py"


use rule diagnose as diagnose_fold with:
    input:
        **fold_runs(),
        campaign=lambda w: study.campaign_file,
    output:
        f"{F}/diagnosis.json",
    log:
        f"{F}/logs/diagnose.log",
    benchmark:
        f"{F}/benchmarks/diagnose.tsv"


use rule add as add_fold with:
    input:
        diagnosis=f"{F}/diagnosis.json",
    output:
        f"{F}/models/effects/model.yaml",
    log:
        f"{F}/logs/add.log",
    benchmark:
        f"{F}/benchmarks/add.tsv"


use rule refit as refit_fold with:
    input:
        **fold_runs(),
        campaign=lambda w: study.campaign_file,
    output:
        f"{F}/models/refitted/model.yaml",
    log:
        f"{F}/logs/refit.log",
    benchmark:
        f"{F}/benchmarks/refit.tsv"


use rule train as train_fold with:
    input:
        motions=lambda w: expand(
            f"{F}/motions/{{run}}.npz",
            fold=w.fold,
            run=folds.train_runs(w.fold, w.control),
        ),
        campaign=lambda w: study.campaign_file,
        model=lambda w: (
            [f"{R}/folds/{w.fold}/models/effects/model.yaml"] if w.base else []
        ),
    output:
        model=f"{F}/models/{{base}}{{residual}}_{{control}}/model.yaml",
        arrays=f"{F}/models/{{base}}{{residual}}_{{control}}/residual.npz",
    log:
        f"{F}/logs/train/{{base}}{{residual}}_{{control}}.log",
    benchmark:
        f"{F}/benchmarks/train/{{base}}{{residual}}_{{control}}.tsv"


rule fold:
    "Replay and score the held-out run with every model that never saw it."
    input:
        motion=f"{F}/motions/{{fold}}.npz",
        campaign=lambda w: study.campaign_file,
        models=lambda w: expand(
            f"{F}/models/{{model}}/model.yaml",
            fold=w.fold,
            model=folds.models(w.fold),
        ),
    output:
        f"{F}/comparison.json",
    log:
        f"{F}/logs/fold.log",
    benchmark:
        f"{F}/benchmarks/fold.tsv"
    params:
        settings=depends.section(SimulationSections),
        code=code_of("fold", MODEL_FILES),
    script:
        "../scripts/fold.py"


if folds.published:

    rule against_published:
        "Compare the errors on held-out runs with those that others published for them."
        input:
            comparisons=expand(f"{F}/comparison.json", fold=folds.runs),
            motions=expand(f"{R}/motions/{{run}}.npz", run=folds.runs),
            published=str(folds.published),
        output:
            published_errors=f"{R}/published_errors.json",
            csv=f"{R}/tables/published_errors.csv",
            tex=f"{R}/tables/published_errors.tex",
        log:
            f"{R}/logs/against_published.log",
        benchmark:
            f"{R}/benchmarks/against_published.tsv"
        params:
            code=code_of("against_published"),
        script:
            "../scripts/against_published.py"


if folds.pitfalls:

    rule pitfalls:
        "Measure what four mistakes of the thesis' public code cost, on each held-out run."
        input:
            motions=expand(f"{R}/motions/{{run}}.npz", run=folds.runs),
            models=expand(f"{F}/models/effects/model.yaml", fold=folds.runs),
        output:
            f"{R}/pitfalls.json",
        log:
            f"{R}/logs/pitfalls.log",
        benchmark:
            f"{R}/benchmarks/pitfalls.tsv"
        params:
            settings=depends.section(SimulationSections),
            learners={kind: depends.learner(kind) for kind in ("knn", "gp")},
            code=code_of("pitfalls", MODEL_FILES),
        script:
            "../scripts/pitfalls.py"
