rule replay:
    "Drive one model with the logged commands of all runs: open loop and windows."
    input:
        motions=expand(f"{R}/motions/{{run}}.npz", run=study.runs()),
        campaign=lambda w: study.campaign_file,
        model=model_files,
    output:
        expand(f"{R}/replay/{{{{model}}}}/{{run}}.npz", run=study.runs()),
    log:
        f"{R}/logs/replay/{{model}}.log",
    benchmark:
        f"{R}/benchmarks/replay/{{model}}.tsv"
    params:
        settings=depends.section(SimulationSections),
        code=code_of("replay"),
    script:
        "../scripts/replay.py"


rule search:
    "Under which conditions one model fails, on all runs it may be judged on."
    input:
        motions=expand(f"{R}/motions/{{run}}.npz", run=study.runs()),
        campaign=lambda w: study.campaign_file,
        model=model_files,
    output:
        f"{R}/where/{{model}}.json",
    log:
        f"{R}/logs/search/{{model}}.log",
    benchmark:
        f"{R}/benchmarks/search/{{model}}.tsv"
    params:
        settings=depends.section(SimulationSections),
        code=code_of("search"),
    script:
        "../scripts/search.py"


rule budget:
    "Who pushes how much in one run, by the nominal model, and what is missing."
    input:
        motion=f"{R}/motions/{{run}}.npz",
        campaign=lambda w: study.campaign_file,
    output:
        f"{R}/budget/{{run}}.npz",
    log:
        f"{R}/logs/budget/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/budget/{{run}}.tsv"
    params:
        settings=depends.section(SimulationSections),
        code=code_of("budget"),
    script:
        "../scripts/budget.py"


rule score:
    "Errors of one model on all runs: a job a run would take longer to start than to score."
    input:
        motions=expand(f"{R}/motions/{{run}}.npz", run=study.runs()),
        replays=expand(f"{R}/replay/{{{{model}}}}/{{run}}.npz", run=study.runs()),
    output:
        f"{R}/scores/{{model}}.json",
    log:
        f"{R}/logs/score/{{model}}.log",
    benchmark:
        f"{R}/benchmarks/score/{{model}}.tsv"
    params:
        code=code_of("score"),
    script:
        "../scripts/score.py"
