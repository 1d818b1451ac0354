"""Types: the module holds under mypy --strict, and so does code that uses it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import impactid

USE = """
from matplotlib.axes import Axes
import impactid
results = impactid.Results("results")
axes: Axes = results.plot_map(dimensionless=True)
axes = results.plot_residuals("trajectories")
axes = results.plot_record("r0001", "velocity", ax=axes)
value: float = results.joint["restitution"].value or 0.0
peak: float = results.waveform("r0001").measured["velocity_x"].values.max()
html: str = results._repr_html_()
results.plot_map(dimensionless="yes")
"""


def mypy(*arguments, cwd):
    pytest.importorskip("mypy")
    pytest.importorskip("matplotlib")
    source = Path(impactid.__file__).parent.parent
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(cwd / "cache"), *arguments],
        capture_output=True,
        text=True,
        cwd=cwd,
        env={**os.environ, "MYPYPATH": str(source)},
        check=False,
    )
    return done.stdout + done.stderr


def test_the_module_is_typed_throughout(tmp_path):
    folder = Path(impactid.__file__).parent
    assert (folder / "py.typed").is_file()
    said = mypy(str(folder), cwd=tmp_path)
    assert said.startswith("Success"), said


def test_code_that_uses_the_module_is_checked(tmp_path):
    (tmp_path / "use.py").write_text(USE)
    said = mypy("use.py", cwd=tmp_path)
    assert "Found 1 error" in said, said
    assert "use.py:11" in said and '"dimensionless"' in said, said
