"""What the edges share.

conf_search        where Hydra looks
sections           sections of the configuration that several steps take
settings           what each command and rule takes of it
configuration      composed once, by Hydra
pipeline           the way of the data, one step a file
study              the study as the workflow sees it, and each run of it held out once
snakemake_job      what surrounds the script of a rule
provenance         where a result came from
tracking           MLflow
export             a model written for another simulator
"""
