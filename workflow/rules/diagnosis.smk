rule diagnose:
    "Diagnose the nominal model on the train runs; measure the improvement on the test runs."
    input:
        **clean_runs(),
        campaign=lambda w: study.campaign_file,
    output:
        f"{R}/diagnosis.json",
    log:
        f"{R}/logs/diagnose.log",
    benchmark:
        f"{R}/benchmarks/diagnose.tsv"
    priority: 10  # most of the study waits for it
    params:
        settings=depends.section(DiagnosisSettings),
        code=code_of("diagnose"),
    script:
        "../scripts/diagnose.py"


rule add:
    "Add the effects that the diagnosis selected to the nominal model."
    input:
        diagnosis=f"{R}/diagnosis.json",
    output:
        f"{R}/models/effects/model.yaml",
    log:
        f"{R}/logs/add.log",
    benchmark:
        f"{R}/benchmarks/add.tsv"
    params:
        code=code_of("add"),
    script:
        "../scripts/add.py"


rule refit:
    "Refit the nominal model's own parameters to the train runs."
    input:
        **clean_runs(),
        campaign=lambda w: study.campaign_file,
    output:
        f"{R}/models/refitted/model.yaml",
    log:
        f"{R}/logs/refit.log",
    benchmark:
        f"{R}/benchmarks/refit.tsv"
    params:
        settings=depends.section(DiagnosisSettings),
        code=code_of("refit"),
    script:
        "../scripts/refit.py"
