if study.synthetic:

    rule tank:
        "Fly the synthetic campaign and write its raw exports."
        output:
            study.raw(),
        log:
            f"{R}/logs/tank.log",
        benchmark:
            f"{R}/benchmarks/tank.tsv"
        params:
            settings=study.settings.tank.model_dump_json(),
            code=depends.own_code("simulation.synthetic_tank"),
        script:
            "../scripts/tank.py"


rule read:
    "Read one raw export: convert axes to NED and FRD, assess its quality, filter nothing."
    input:
        raw=lambda wildcards: study.raw(wildcards.run),
    output:
        recording=f"{R}/recordings/{{run}}.npz",
        quality=f"{R}/quality/{{run}}.json",
    log:
        f"{R}/logs/read/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/read/{{run}}.tsv"
    params:
        campaign=study.campaign_file,
        settings=depends.signal("outliers"),
        code=code_of("read", without="rovsim.dynamics.effects"),
    script:
        "../scripts/read.py"
