"""Results as they are written and read: one frozen model for each JSON file.

base              what all results share
fitted            fitted values, how these hang together, and the noise
diagnosis         `diagnosis.json`
comparison        `comparison.json`
ladder            `ladder.json`
error_conditions  `where.json`
growth            `growth.json`
force_budget      `budget.json`, and the forces over the time
bands             `bands.json`
experiment        `experiment.json`
quality           `quality/RUN.json`
timing            `timing.json`, `bench.json`
published_errors  `published_errors.json`
pitfalls          `pitfalls.json`
blind_benchmark   `summary.json` of the blind benchmark
finished_run      `finished.json` of a run of a sweep
design_benchmark  `CASE.json` of the benchmark of designs
"""
