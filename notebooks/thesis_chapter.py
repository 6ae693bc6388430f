# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # The figures and tables of a chapter
#
# Physics first, then a learned residual for what is left. Everything is written as a thesis takes
# it: figures as PDF, 150 mm wide, and tables for LaTeX (packages `booktabs` and `siunitx`). The
# recordings are those of [the tutorial](tutorial.py): run that first, or open a campaign of your
# own.

# %%
from pathlib import Path

import rovsim

campaign = rovsim.open("practice")

# %% [markdown]
# ## Three models
#
# The nominal model, the model with the effects that the diagnosis found, and k nearest neighbours
# on top of that. The residual is trained on the train runs alone.

# %%
found = campaign.diagnose()
repaired = campaign.add(found, "repaired.yaml")
learned = campaign.train("knn", model=repaired, control="6dof", path="learned.yaml", k=5)
compared = campaign.compare("nominal", repaired, learned)
compared.errors

# %% [markdown]
# ## Errors by axis, on the test runs

# %%
compared.table("velocity_rmse", horizon="2")

# %% [markdown]
# ## Figures and tables on disk

# %%
written = found.save("ladder", "chapter/figures")
for name in ("error_by_axis", "error_growth"):
    written += compared.save(name, "chapter/figures")
written += compared.save("velocities", "chapter/figures", run="6dof-2")
written += compared.printed("velocity_rmse").write(Path("chapter/tables"), "velocity_rmse")
sorted(str(path) for path in written)
