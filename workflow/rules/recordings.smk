if study.synthetic:

    rule tank:
        "Fly the synthetic campaign and write its raw exports."
        output:
            study.tank_files,
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
    "Read one raw export: convert axes to NED and FRD, filter nothing."
    input:
        campaign=lambda w: study.campaign_file,
        raw=lambda w: study.raw(w.run),
    output:
        recording=f"{R}/recordings/{{run}}.npz",
        anomalies=f"{R}/anomalies/{{run}}.json",
    log:
        f"{R}/logs/read/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/read/{{run}}.tsv"
    params:
        code=code_of("read", without="rovsim.dynamics.effects"),
    script:
        "../scripts/read.py"


rule judge:
    "Judge the quality of one recording, beside the vehicle and the runs that it may copy."
    input:
        recording=f"{R}/recordings/{{run}}.npz",
        anomalies=f"{R}/anomalies/{{run}}.json",
        campaign=lambda w: study.campaign_file,
        raw=lambda w: study.compared(w.run),
    output:
        f"{R}/quality/{{run}}.json",
    log:
        f"{R}/logs/judge/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/judge/{{run}}.tsv"
    params:
        settings=depends.signal("outliers"),
        code=code_of("judge", without="rovsim.dynamics.effects"),
    script:
        "../scripts/judge.py"
