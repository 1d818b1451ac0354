"""Campaigns: what the program found is what Python reads."""

import json
import math

import pytest

import impactid


def test_the_joint_estimates_hold_the_truth(results, campaign):
    truth = json.loads((campaign.parent / "truth.json").read_text())
    assert results.verdict in ("identified", "weak")
    for name, estimate in results.joint.items():
        low, high = estimate.interval95
        # four standard errors: the interval itself may miss one time in twenty
        assert abs(estimate.value - truth[name]) < 4 * estimate.standard_error, name
        assert low < estimate.value < high
    assert set(results.joint) == {
        "restitution",
        "natural_frequency_hz",
        "damping_ratio",
        "static_deflection_m",
    }


def test_methods_and_budget(results):
    assert results.methods["trajectories"]["restitution"].status == "identified"
    budget = results.budget
    assert {"source", "parameter", "contribution"} <= set(budget.columns)
    assert "combined" in list(budget["source"])


@pytest.mark.parametrize("library", ["polars", "pandas"])
def test_frames(results, library):
    pytest.importorskip(library)
    if library == "pandas":
        pytest.importorskip("pyarrow")
    read = impactid.Results(results.folder, frames=library)
    for frame in (read.records, read.impacts, read.brackets, read.figure("map")):
        assert type(frame).__module__.split(".")[0] == library
        assert frame.shape[0] > 0
    assert read.records.shape[0] == 40
    assert {"frequency_hz", "motion"} <= set(read.records.columns)
    speeds = [v for v in read.impacts["closing_speed_before_m_s"] if v is not None and not math.isnan(v)]
    assert min(speeds) >= 0


def test_wrong_input_is_the_program_s_message(tmp_path):
    with pytest.raises(impactid.ProgramError, match="missing.toml") as caught:
        impactid.run(tmp_path / "missing.toml", tmp_path / "out")
    assert caught.value.code == 2
    with pytest.raises(FileNotFoundError, match="impactid run"):
        impactid.Results(tmp_path)
    with pytest.raises(ValueError, match="polars or pandas"):
        impactid._frames.library("excel")


def test_options_of_the_report_are_handed_on(campaign, tmp_path):
    impactid.run(
        campaign, tmp_path, formats=["html"], title="Unser Prüfstand", language="de", paper="letter", decimal_comma=True
    )
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Unser Prüfstand" in page and '<html lang="de">' in page
    with pytest.raises(impactid.ProgramError, match="none.typ"):
        impactid.run(campaign, tmp_path, template="none.typ")


def test_a_figure_that_is_not_there_is_named(results):
    with pytest.raises(FileNotFoundError, match="map"):
        results.figure("nothing")
