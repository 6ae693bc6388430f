rule train:
    "Learn the acceleration residual of a model, on the train runs of one control."
    input:
        motions=lambda w: expand(
            f"{R}/motions/{{run}}.npz", run=study.train_runs(w.control)
        ),
        campaign=lambda w: study.campaign_file,
        model=lambda w: [f"{R}/models/effects/model.yaml"] if w.base else [],
    output:
        model=f"{R}/models/{{base}}{{residual}}_{{control}}/model.yaml",
        arrays=f"{R}/models/{{base}}{{residual}}_{{control}}/residual.npz",
    log:
        f"{R}/logs/train/{{base}}{{residual}}_{{control}}.log",
    benchmark:
        f"{R}/benchmarks/train/{{base}}{{residual}}_{{control}}.tsv"
    params:
        settings=lambda w: depends.training(w.residual, w.control),
        code=code_of("train"),
    script:
        "../scripts/train.py"


rule timing:
    "Time single predictions by library call and exported predictor, alone on the machine."
    input:
        motion=f"{R}/motions/{study.runs('test')[0]}.npz",
        campaign=lambda w: study.campaign_file,
        models=expand(f"{R}/models/{{model}}/model.yaml", model=models.trained),
    output:
        f"{R}/timing.json",
    log:
        f"{R}/logs/timing.log",
    benchmark:
        f"{R}/benchmarks/timing.tsv"
    threads: workflow.cores
    params:
        settings=depends.section(PredictorSettings),
        code=code_of("timing"),
    script:
        "../scripts/timing.py"
