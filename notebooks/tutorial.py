# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # Find what a simulator is missing
#
# A vehicle was recorded in a tank, and a simulator does not quite do what the vehicle does. This
# notebook shows where the two part, finds out what is missing, adds it, and shows the error on
# runs that nobody fitted anything to.
#
# The tank here is synthetic and its runs last twelve seconds, so that the notebook takes half a
# minute. With recordings of your own begin at `rovsim.open`.

# %%
import rovsim

folder = rovsim.tank("practice", "tank=tiny")

# %% [markdown]
# ## The campaign
#
# Reading checks and cleans every run. Runs of the split `train` are for finding out, those of
# `test` for the proof.

# %%
campaign = rovsim.open(folder)
campaign

# %% [markdown]
# ## How far is the model from the measurement?
#
# Every run is replayed with the logged commands. Every two seconds the model is set to the
# measured state again; the error is that of the velocity, in units of the standard deviation of
# the measured velocity.

# %%
before = campaign.compare("nominal")
before

# %% [markdown]
# Measured and simulated velocity of the test run:

# %%
before.figure("velocities", run="6dof-2")

# %% [markdown]
# ## What is missing?
#
# Every effect of the catalogue is tried, alone and together, on the train runs. The first time
# this takes a while; the diagnosis is kept, and read the next time.

# %%
found = campaign.diagnose()
found

# %%
found.selected

# %% [markdown]
# ## Add it, and look again
#
# The model with the effects is a plain file. It goes wherever a model is asked for.

# %%
repaired = campaign.add(found, "repaired.yaml")
repaired

# %%
after = campaign.compare("nominal", repaired)
after.errors

# %% [markdown]
# ## Back into your simulator
#
# What Gazebo cannot hold is listed with the RMS of its force over these runs.

# %%
campaign.export(repaired, to="gz", path="vehicle.sdf")
