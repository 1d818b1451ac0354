"""The notebook of the documents runs, and is kept without outputs."""

import json
from pathlib import Path

import pytest

import impactid

NOTEBOOK = Path(__file__).resolve().parents[2] / "docs" / "notebook.ipynb"


def cells():
    return [c for c in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"] if c["cell_type"] == "code"]


def test_the_notebook_is_kept_without_outputs():
    assert len(cells()) > 3
    for cell in cells():
        assert cell["outputs"] == [] and cell["execution_count"] is None


def test_the_cells_run_in_order(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "__main__"}
    for cell in cells():
        exec(compile("".join(cell["source"]), NOTEBOOK.name, "exec"), names)
    assert names["results"].verdict in ("identified", "weak")


def test_a_kernel_shows_the_answer_and_the_plots(tmp_path, monkeypatch):
    for tool in ("matplotlib", "nbclient", "nbformat", "ipykernel"):
        pytest.importorskip(tool)
    import nbformat
    from nbclient import NotebookClient

    # the kernel runs in another folder, with the backend of notebooks
    monkeypatch.setenv("PYTHONPATH", str(Path(impactid.__file__).parent.parent))
    monkeypatch.delenv("MPLBACKEND", raising=False)
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    path = {"metadata": {"path": str(tmp_path)}}
    NotebookClient(notebook, timeout=600, kernel_name="python3", resources=path).execute()
    shown = [output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", [])]
    assert any("R</span>" in data.get("text/html", "") for data in shown)
    assert sum("image/png" in data for data in shown) >= 3
