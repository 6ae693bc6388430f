"""The code that docs/elsewhere.md shows runs as it stands there."""

import re
from pathlib import Path

import numpy as np

from rovsim.dynamics.model_file import write_model
from worlds import model

PAGE = Path(__file__).parents[2] / "docs" / "elsewhere.md"


def test_a_loop_of_ones_own_steps_a_model_file(tmp_path, monkeypatch):
    shown = re.search(r"```python\n(import numpy.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
    monkeypatch.chdir(tmp_path)
    write_model(model(), Path("model.yaml"))
    loop = {"commands": [np.full(8, 0.3)] * 50}
    exec(shown[1], loop)
    assert loop["state"].shape == (13,)
    assert np.linalg.norm(loop["state"][7:10]) > 1e-3  # it moves
