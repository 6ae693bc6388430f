"""What the commands, the workbench, the notebook and the workflow share.

conf_groups        the options of the groups of the configuration
conf_search        where Hydra looks for configuration
sections           sections of the configuration that several steps take
settings           the settings that each command and rule takes from the configuration
configuration      composes the configuration with Hydra, in one place
pipeline           the steps from raw files to results, one step a file
study              the study as the workflow sees it; each run held out once
snakemake_job      logging and errors around the script of a rule
provenance         where a result came from
tracking           MLflow runs of models and diagnoses
export             writes a model for another simulator
"""
