"""Plots: what is drawn is what the results hold."""

import csv
import json
import shutil
import sys

import numpy as np
import pytest

import impactid

RIG = ("restitution", "damping_ratio")


@pytest.fixture()
def pyplot():
    pytest.importorskip("matplotlib")
    from matplotlib import pyplot

    yield pyplot
    pyplot.close("all")


def rows(results, name):
    with (results.folder / "figures" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def lines(axes, *words):
    """Lines whose label contains one of the words."""
    return [line for line in axes.get_lines() if any(w in str(line.get_label()) for w in words)]


def record_with_impacts(results):
    """The record whose motion is surest of those with one impact in a period."""
    table = zip(*(list(results.records[n]) for n in ("record", "motion", "confidence")))
    return max((row for row in table if row[1] == "1"), key=lambda row: row[2])[0]


def test_the_map_shows_every_record_where_it_was_measured(results, pyplot):
    axes = results.plot_map()
    marks = [l for l in axes.get_lines() if l.get_linestyle() == "None"]
    drawn = {(float(x), float(y)) for l in marks for x, y in zip(*l.get_data())}
    measured = [row for row in rows(results, "map") if row["layer"] == "record"]
    expected = {(float(r["frequency_hz"]), 1e3 * float(r["clearance_m"])) for r in measured}
    assert len(measured) == 40 and drawn == expected
    assert axes.get_xlabel() == "drive frequency, Hz" and axes.get_ylabel() == "clearance, mm"
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert all(left < x < right and low < y < high for x, y in drawn)
    axes.figure.canvas.draw()


def test_the_simulated_boundaries_are_those_of_the_identified_parameters(results, pyplot):
    f0 = results.joint["natural_frequency_hz"].value
    x_st_mm = 1e3 * results.joint["static_deflection_m"].value
    rig = {name: results.joint[name].value for name in RIG}
    (grazing,) = lines(results.plot_map(), "grazing")
    frequency, clearance = grazing.get_data()
    middle = len(frequency) // 3
    eta = frequency[middle] / f0
    expected = impactid.boundary("grazing", eta=eta, **rig).rho[0]
    # the map's rig has the small asymmetries that were identified too
    assert clearance[middle] / x_st_mm == pytest.approx(expected, rel=0.02)


def test_both_planes_show_the_same_map(results, pyplot):
    laboratory, dimensionless = results.plot_map(), results.plot_map(dimensionless=True)
    assert laboratory is not dimensionless
    assert dimensionless.get_xlabel() == "frequency ratio $η$"
    f0 = results.joint["natural_frequency_hz"].value
    for a, b in zip(lines(laboratory, "$z$"), lines(dimensionless, "$z$")):
        np.testing.assert_allclose(a.get_xdata(), f0 * b.get_xdata(), rtol=1e-6)


def test_a_boundary_is_one_line_and_does_not_jump(results, pyplot):
    axes = results.plot_map(dimensionless=True)
    curves = [l for l in axes.get_lines() if l.get_color() == "#5f666d"]
    assert len(curves) >= 3
    for line in curves:
        assert np.all(np.diff(line.get_xdata()) > 0)


def test_a_map_without_f0_shows_records_and_no_boundaries(results, tmp_path, pyplot):
    shutil.copytree(results.folder, tmp_path / "copy")
    path = tmp_path / "copy" / "identification.json"
    found = json.loads(path.read_text(encoding="utf-8"))
    found["joint"]["natural_frequency_hz"].update(value=None, interval95=None)
    path.write_text(json.dumps(found), encoding="utf-8")
    axes = impactid.Results(tmp_path / "copy").plot_map()
    assert lines(axes, "$z$ = 0") and not lines(axes, "simulated")


def test_residuals_are_those_of_the_method(results, pyplot):
    of = {"resonance_curve": "residuals_1", "trajectories": "residuals_2"}
    for method, name in of.items():
        axes = results.plot_residuals(method)
        (line,) = [l for l in axes.get_lines() if l.get_marker() == "."]
        expected = rows(results, name)
        assert set(r["record"] for r in expected) <= used_by(results, method)
        np.testing.assert_array_equal(line.get_ydata(), [float(r["residual"]) for r in expected])
    assert len(results.plot_residuals().get_legend().get_texts()) == 3
    with pytest.raises(ValueError, match="trajectories"):
        results.plot_residuals("guessing")


def used_by(results, method):
    names = list(results.records["record"])
    return {names[i] for i in results.identification["used_by"][method]}


def test_impacts_of_a_waveform_are_where_the_velocity_jumps(results):
    waveform = results.waveform(record_with_impacts(results))
    assert len(waveform.impacts_s) >= 3
    velocity = waveform.measured["velocity_x"]
    assert velocity.unit == "m/s"
    step = np.median(np.diff(velocity.time_s))
    jumps = np.abs(np.diff(velocity.values))
    for impact in waveform.impacts_s[1:-1]:
        near = np.abs(velocity.time_s[:-1] - impact) < 3 * step
        assert jumps[near].max() > 10 * np.median(jumps)


def test_a_simulated_waveform_is_like_the_measured_one(results):
    waveform = results.waveform(record_with_impacts(results))
    measured, simulated = (w["velocity_x"] for w in (waveform.measured, waveform.simulated))
    np.testing.assert_array_equal(measured.time_s, simulated.time_s)
    # samples at impacts differ by whole jumps where the times differ by a fraction of a sample
    residual = np.median(np.abs(measured.values - simulated.values))
    assert residual < 0.1 * np.std(measured.values)


def test_a_record_is_plotted_with_its_impacts(results, pyplot):
    record = record_with_impacts(results)
    axes = results.plot_record(record)
    assert axes.get_ylabel() == "velocity, mm/s" and axes.get_title() == record
    (line,) = lines(axes, "x measured")
    waveform = results.waveform(record)
    np.testing.assert_allclose(line.get_ydata(), 1e3 * waveform.measured["velocity_x"].values)
    verticals = [l for l in axes.get_lines() if len(l.get_xdata()) == 2]
    at = [float(l.get_xdata()[0]) for l in verticals]
    np.testing.assert_allclose(at, 1e3 * waveform.impacts_s)
    assert results.plot_record(record, "displacement").get_ylabel() == "displacement, mm"
    with pytest.raises(ValueError, match="velocity, displacement"):
        results.plot_record(record, "acceleration")


def test_plots_are_drawn_on_axes_that_are_given(results, pyplot):
    _, given = pyplot.subplots(1, 3)
    assert results.plot_map(ax=given[0]) is given[0]
    assert results.plot_residuals(ax=given[1]) is given[1]
    assert results.plot_record(record_with_impacts(results), ax=given[2]) is given[2]


def test_records_that_cannot_be_plotted_are_named(results, tmp_path):
    pytest.importorskip("matplotlib")
    with pytest.raises(ValueError, match="nobody"):
        results.plot_record("nobody")
    shutil.copytree(results.folder, tmp_path / "copy")
    path = tmp_path / "copy" / "campaign.resolved.json"
    campaign = json.loads(path.read_text(encoding="utf-8"))
    for entry in campaign["records"]:
        entry["file"] = "gone/records.h5"
    path.write_text(json.dumps(campaign), encoding="utf-8")
    with pytest.raises(FileNotFoundError, match="gone/records.h5.*above the results"):
        impactid.Results(tmp_path / "copy").plot_record(record_with_impacts(results))


def test_a_waveform_is_found_from_another_directory(campaign, tmp_path, monkeypatch):
    shutil.copytree(campaign.parent, tmp_path / "rig")
    monkeypatch.chdir(tmp_path)
    record = record_with_impacts(impactid.run("rig/campaign.toml", "results", formats=["csv"]))
    expected = impactid.Results(tmp_path / "results").waveform(record)
    monkeypatch.chdir(tmp_path / "rig")
    found = impactid.Results(tmp_path / "results").waveform(record)
    assert found.measured.keys() == expected.measured.keys()
    np.testing.assert_array_equal(found.impacts_s, expected.impacts_s)


def test_without_matplotlib_the_remedy_is_named(results, monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    for plot in (results.plot_map, results.plot_residuals, lambda: results.plot_record("r0000")):
        with pytest.raises(ImportError, match=r"pip install impactid\[plot\]"):
            plot()


def test_matplotlib_is_imported_by_plots_alone(tmp_path):
    import subprocess

    said = subprocess.run(
        [sys.executable, "-c", "import sys, impactid; print('matplotlib' in sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.strip() == "False"
