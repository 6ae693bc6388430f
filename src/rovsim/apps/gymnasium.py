"""The simulator as a Gymnasium environment: fly to a place and stay there.

    import gymnasium
    env = gymnasium.make("rovsim.apps.gymnasium:rovsim/Vehicle-v0", model="model.yaml")

Needs the extra `rovsim[gym]`. For a task of your own, override `reward` and `_goal`.
"""

from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from numpy import ndarray as Array

from rovsim.dynamics.catalogue import load_catalogue
from rovsim.dynamics.model import Model
from rovsim.dynamics.model_file import load_model
from rovsim.dynamics.vehicle import default_vehicle, load_vehicle
from rovsim.simulation.rest import rest_state
from rovsim.simulation.stepper import Stepper

ENVIRONMENT_ID = "rovsim/Vehicle-v0"


class VehicleEnv(gymnasium.Env[Array, Array]):
    """A vehicle that starts at rest and level near the origin.

    An action (n,) is one command in [-1, 1] per thruster, of what the vehicle allows. An
    observation (16,) is the state (13,) of `rovsim.simulation.stepper` and the goal (3,), m in
    NED. The reward is minus the distance to the goal in m, minus the mean square of the action. An
    episode is cut off after `seconds`, and ends where the vehicle is more than three times `reach`
    from the origin on some axis.

    Args:
        model: a built-in model, the path of a model file (with residual and all), or a model.
        vehicle: of a built-in model; a name in conf/vehicle/.
        dt: s between two actions.
        seconds: of an episode.
        reach: m, goals lie within a cube of this half width.

    Raises:
        BadInput: no such model or vehicle, or a model that cannot be stepped.
    """

    metadata = {"render_modes": []}  # noqa: RUF012 - Gymnasium's own declaration

    def __init__(
        self,
        model: str | Model = "nominal",
        vehicle: str | None = None,
        dt: float = 0.05,
        seconds: float = 30.0,
        reach: float = 2.0,
    ) -> None:
        loaded = (
            model
            if isinstance(model, Model)
            else load_model(model, load_vehicle(vehicle or default_vehicle()), load_catalogue())
        )
        self.stepper = Stepper(loaded, duration=seconds)
        self.dt, self.seconds, self.reach = dt, seconds, reach
        self.limit = loaded.vehicle.thrusters.command_limit
        self.action_space = Box(-1.0, 1.0, (self.stepper.columns,), np.float64)
        edge = np.concatenate([np.full(3, np.inf), np.full(4, 1.01), np.full(6, np.inf)])
        edge = np.concatenate([edge, np.full(3, reach)])
        self.observation_space = Box(-edge, edge, dtype=np.float64)
        self.state, self.goal = np.zeros(13), np.zeros(3)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Start with a random heading and goal; `options` may set `state` (13,) and `goal` (3,)."""
        super().reset(seed=seed)
        options = options or {}
        self.stepper.reset()
        start = rest_state(np.zeros(3), self.np_random.uniform(-np.pi, np.pi))
        self.goal = np.array(options.get("goal", self._goal()), dtype=np.float64)
        self.state = np.array(options.get("state", start), dtype=np.float64)
        return self._observation(), {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Hold an action (n,) for `dt` s; values beyond [-1, 1] count as -1 or 1."""
        action = np.clip(action, -1.0, 1.0)
        self.state = self.stepper.step(self.state, self.limit * action, self.dt)
        terminated = bool(np.abs(self.state[:3]).max() > 3.0 * self.reach)
        truncated = self.stepper.time >= self.seconds - 1e-9
        return self._observation(), self.reward(action), terminated, truncated, {}

    def reward(self, action: Array) -> float:
        """Return the reward of the action (n,) that led to the present state."""
        distance = float(np.linalg.norm(self.state[:3] - self.goal))
        return -distance - float(np.mean(action**2))

    def _goal(self) -> Array:
        return self.np_random.uniform(-self.reach, self.reach, 3)

    def _observation(self) -> Array:
        return np.concatenate([self.state, self.goal])


gymnasium.register(ENVIRONMENT_ID, entry_point=f"{__name__}:VehicleEnv")
