"""What is compiled ahead is what a diagnosis calls: same functions, same types."""

import subprocess
import sys

import pytest

SCRIPT = """
from rovsim.apps.cli.main import main
from rovsim.dynamics.catalogue import built_in
from rovsim.dynamics.engine.modules import engine
from rovsim.simulation.compiled_ahead import compile_ahead

def known():
    wrenches = built_in().wrenches
    functions = engine(wrenches).observe, engine(wrenches).integrate, engine(()).integrate
    return [set(function.signatures) for function in functions]

if __name__ == "__main__":
    assert not any(known())
    compile_ahead()
    ahead = known()
    assert all(len(one) == 1 for one in ahead), ahead
    main(["tank", "tank=tiny", "out=raw", "--quiet"])
    main(["diagnose", "campaign=raw", "out=found", "--quiet"])
    assert known() == ahead, (known(), ahead)
"""


@pytest.mark.thorough
def test_a_diagnosis_compiles_nothing_anew_of_what_was_compiled_ahead(tmp_path):
    (tmp_path / "ask.py").write_text(SCRIPT)
    done = subprocess.run(
        [sys.executable, "ask.py"], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "found" / "diagnosis.json").exists()
