"""The co-simulation unit, checked and run by FMPy."""

import numpy as np
import pytest

from rovsim.apps.cli.main import main
from rovsim.dynamics.effects.thrusters import ThrusterLag
from rovsim.dynamics.model_file import write_model
from rovsim.simulation.stepper import Stepper
from worlds import at_rest, model, sticks


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_the_unit_moves_as_the_model_does(tmp_path):
    from fmpy import simulate_fmu
    from fmpy.validation import validate_fmu

    world = model(ThrusterLag(time_constant=0.1))
    write_model(world, tmp_path / "lagging.yaml")
    unit = tmp_path / "lagging.fmu"
    main(["fmu", f"model={tmp_path / 'lagging.yaml'}", f"out={unit}"])
    assert validate_fmu(str(unit)) == []
    command = sticks(4)[0]
    starts = {f"command_{i + 1}": c for i, c in enumerate(command)} | {"start_z": 1.5}
    found = simulate_fmu(
        str(unit),
        stop_time=0.5,
        step_size=0.01,
        output_interval=0.01,
        start_values=starts,
        output=["z", "u", "r"],
    )
    stepper, state = Stepper(world), at_rest()
    state[2] = 1.5
    for row in found[1:]:
        state = stepper.step(state, command, 0.01)
        np.testing.assert_allclose([row[n] for n in ("z", "u", "r")], state[[2, 7, 12]], atol=1e-12)


@pytest.mark.parametrize("words", [["model=[nominal,nominal]"], ["out=unit.zip"]])
def test_what_is_no_unit_is_refused(words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main(["fmu", *words])
    assert ended.value.code == 2
    assert "rovsim: " in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
