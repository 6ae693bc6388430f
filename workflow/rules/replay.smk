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
        code=code_of("replay", MODEL_FILES),
    script:
        "../scripts/replay.py"


rule search:
    "Find under which conditions one model fails, on the runs that it may be judged on."
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
        code=code_of("search", MODEL_FILES),
    script:
        "../scripts/search.py"


rule budget:
    "Balance the forces of the nominal model over one run: those of each effect, and the rest."
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
        code=code_of("budget", MODEL_FILES),
    script:
        "../scripts/budget.py"
