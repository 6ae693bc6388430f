# ---
# jupyter:
#   jupytext:
#     text_representation: {extension: .py, format_name: percent}
#   kernelspec: {display_name: Python 3, language: python, name: python3}
# ---

# %% [markdown]
# # An effect of one's own
#
# A net hangs across the front of the vehicle. Its drag in surge is that of a flat plate with
# holes. An effect is one Python file with one class; [the page on own
# effects](../docs/your_own_effect.md) explains every part of it.

# %%
from pathlib import Path

import rovsim

Path("net_panel.py").write_text('''
from rovsim.dynamics.effects.base import Coefficients, Parameter

DENSITY, PLATE = 1000.0, 1.17  # kg/m3; drag coefficient of a square plate (Hoerner 1965)


class NetPanel(Coefficients):
    """A net across the front brakes like a plate with holes."""

    id = "net_panel"
    equation = r"X = -\\\\tfrac{\\\\rho}{2} C_D A\\\\,|u_r|\\\\,u_r"
    neglects = "the moment of the drag, and water that the net takes along"
    source = "Hoerner 1965, Fluid-Dynamic Drag (square plate)"
    parameters = (Parameter("area", "m2", "A", low=0.0, scale=0.05),)

    def enter(self, body):
        """More quadratic damping in surge."""
        body.quadratic[0] += 0.5 * DENSITY * PLATE * self["area"]
''')

# %% [markdown]
# ## A tank that has it
#
# The synthetic tank takes the same file. The vehicle that flies there carries a net of 0.15 m².

# %%
hidden = "tank.effects=[{effect: net_panel, parameters: {area: 0.15}}]"
folder = rovsim.tank("nets", "tank=tiny", hidden, "tank.name=nets", effects_file="net_panel.py")
campaign = rovsim.open(folder, effects_file="net_panel.py")
campaign

# %% [markdown]
# ## A model that has it

# %%
Path("with_net.yaml").write_text('''
vehicle: bluerov2_heavy
effects:
  - {effect: net_panel, parameters: {area: 0.15}}
''')
compared = campaign.compare("nominal", "with_net.yaml")
compared.errors

# %% [markdown]
# The error in surge, in windows of half a second to five:

# %%
compared.figure("error_growth")

# %% [markdown]
# `campaign.diagnose()` would now rank the net beside the effects of the catalogue. More drag in
# surge is also what the effect `quadratic_damping` means: no recording can tell the two apart,
# and the diagnosis says so.
