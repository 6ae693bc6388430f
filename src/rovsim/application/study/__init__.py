"""The study as the workflow sees it.

snakemake_config   what Snakemake was told: settings, effects
study              the campaign, its runs and files, and where results lie
models             which models it makes, shows and searches
leave_one_run_out  each run held out once, and published errors
dependencies       settings and code that a rule depends on
lock               one study of a campaign at a time
"""
