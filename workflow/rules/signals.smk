rule resample:
    "Reject outliers and put the poses on a uniform clock; long gaps stay gaps."
    input:
        recording=f"{R}/recordings/{{run}}.npz",
    output:
        f"{R}/resampled/{{run}}.npz",
    log:
        f"{R}/logs/resample/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/resample/{{run}}.tsv"
    params:
        settings=depends.signal("outliers", "resample"),
        code=code_of("resample"),
    script:
        "../scripts/resample.py"


rule filter:
    "Smooth the poses without delay."
    input:
        poses=f"{R}/resampled/{{run}}.npz",
    output:
        f"{R}/filtered/{{run}}.npz",
    log:
        f"{R}/logs/filter/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/filter/{{run}}.tsv"
    params:
        settings=depends.signal("filter"),
        code=code_of("filter"),
    script:
        "../scripts/filter.py"


rule differentiate:
    "Derive velocities and accelerations in body axes."
    input:
        poses=f"{R}/filtered/{{run}}.npz",
        quality=f"{R}/quality/{{run}}.json",
    output:
        f"{R}/motions/{{run}}.npz",
    log:
        f"{R}/logs/differentiate/{{run}}.log",
    benchmark:
        f"{R}/benchmarks/differentiate/{{run}}.tsv"
    params:
        settings=depends.signal("differentiate"),
        code=code_of("differentiate"),
    script:
        "../scripts/differentiate.py"
