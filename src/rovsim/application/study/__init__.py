"""The study as the workflow sees it.

snakemake_config   what Snakemake was told: settings, effects
study              the campaign, its runs and files, and where results lie
models             which models the study makes, shows and searches
leave_one_run_out  splits with each run held out once, and published errors
dependencies       settings and code that a rule depends on
lock               keeps two studies of one campaign from running at the same time
"""
