"""The Gymnasium environment, by Gymnasium's own checker."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from rovsim.apps.gymnasium import ENVIRONMENT_ID, VehicleEnv
from rovsim.simulation.stepper import Stepper
from worlds import model

UNBOUNDED = "ignore:.*infinity:UserWarning"  # positions and velocities have no bound


@pytest.mark.filterwarnings(UNBOUNDED)
def test_gymnasium_s_checker_finds_no_fault():
    check_env(VehicleEnv(), skip_render_check=True)


@pytest.mark.filterwarnings(UNBOUNDED)
def test_it_is_made_by_its_name():
    env = gymnasium.make(f"rovsim.apps.gymnasium:{ENVIRONMENT_ID}", seconds=0.2)
    env.reset(seed=0)
    ends = [env.step(np.zeros(8))[3] for _ in range(4)]
    assert ends == [False, False, False, True]


def test_it_moves_as_the_model_does():
    env, stepper = VehicleEnv(model()), Stepper(model())
    seen, _ = env.reset(seed=3)
    state, action = seen[:13], np.linspace(-1.0, 1.0, 8)
    for _ in range(5):
        state = stepper.step(state, env.limit * action, 0.05)
        seen, reward, lost, late, _ = env.step(action)
    np.testing.assert_array_equal(seen[:13], state)
    assert reward == pytest.approx(-np.linalg.norm(state[:3] - seen[13:]) - np.mean(action**2))
    assert not lost
    assert not late


def test_far_out_an_episode_ends():
    env = VehicleEnv(reach=1.0)
    far = np.zeros(13)
    far[[0, 3]] = 3.5, 1.0
    env.reset(seed=0, options={"state": far, "goal": np.zeros(3)})
    assert env.step(np.zeros(8))[2]
