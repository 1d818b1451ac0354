"""Waveforms of a record, measured and simulated: the program replays it from the results."""

from __future__ import annotations

import json
import math
import re
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Sequence, Tuple

import numpy as np

from ._columns import Array, columns, numbers
from ._program import start

#: What the program reads to write a report again, of a run and of stages.
_KEPT = (
    "identification.json",
    "report_data.json.gz",
    "observations.json.gz",
    "residuals.json.gz",
)
_HEAD = re.compile(r"(?P<role>\w+) (?P<source>measured|simulated)(?: \((?P<unit>[^)]*)\))?$")


@dataclass(frozen=True)
class Signal:
    """A channel over time.

    Attributes:
        time_s: time from a zero phase of the drive.
        values: samples in `unit`.
        unit: unit of SI, or V; empty where there is none.
    """

    time_s: Array
    values: Array
    unit: str


@dataclass(frozen=True)
class Waveform:
    """The stretch of a record that the report shows, from the first zero phase of its drive.

    Attributes:
        record: the record's name.
        measured: the measured channels by role, as velocity_x; y is positive toward x.
        simulated: those of the motion that the identified parameters give, as far as it was simulated.
        impacts_s: times of the measured impacts on the same axis.
    """

    record: str
    measured: dict[str, Signal]
    simulated: dict[str, Signal]
    impacts_s: Array


def signals(table: Mapping[str, list[str]]) -> dict[str, dict[str, Signal]]:
    """The signals of a table of a comparison by source and role."""
    time = numbers(table.get("time_s", []))
    found: dict[str, dict[str, Signal]] = {"measured": {}, "simulated": {}}
    for head, cells in table.items():
        match = _HEAD.match(head)
        values = numbers(cells)
        if match is None or values is None or time is None:
            continue
        # a signal on times of its own has empty cells at those of the others
        there = np.isfinite(values)
        signal = Signal(time[there], values[there], match["unit"] or "")
        found[match["source"]][match["role"]] = signal
    return found


def replay(folder: Path, record: str) -> dict[str, dict[str, Signal]]:
    """The signals of a record: the program writes the figures' data with it as the only point.

    Raises:
        FileNotFoundError: where the record's file is not found, or results lack what a report needs.
        ValueError: where the record has no waveform to be compared.
    """
    campaign = json.loads((folder / "campaign.resolved.json").read_text(encoding="utf-8"))
    campaign = _found(folder, campaign)
    _require_file(campaign, record)
    # nothing but the data of its figures is written
    campaign["report"].update(points=[record], template=None, words=None, logo=None)
    with tempfile.TemporaryDirectory(prefix="impactid-") as name:
        copy = Path(name)
        for kept in _KEPT:
            if (folder / kept).is_file():
                shutil.copyfile(folder / kept, copy / kept)
        (copy / "campaign.resolved.json").write_text(json.dumps(campaign), encoding="utf-8")
        start(["--quiet", "report", str(copy), "--format", "csv"])
        path = copy / "figures" / "comparison_A.csv"
        if not path.is_file():
            raise ValueError(f"{record} has no waveform that the report could show")
        return signals(columns(path))


def _found(folder: Path, campaign: dict[str, Any]) -> dict[str, Any]:
    """The campaign with paths that lead to its files: below where the results state that they begin, the working
    directory, or the nearest folder above the results from which they do. The program finds them so too."""
    results = folder.resolve()
    stated = [results / campaign["paths_begin_at"]] if "paths_begin_at" in campaign else []
    bases = [*stated, Path.cwd(), *results.parents]
    base = next((base for base in bases if (base / campaign["file"]).exists()), None)
    if base is None:
        return campaign
    campaign["file"] = str(base / campaign["file"])
    if campaign.get("run_table") is not None:
        campaign["run_table"] = str(base / campaign["run_table"])
    for entry in campaign["records"]:
        entry["file"] = str(base / entry["file"])
    return campaign


def _require_file(campaign: Mapping[str, Any], record: str) -> None:
    """The program leaves out what it cannot read; here it was asked for."""
    entry = next((entry for entry in campaign["records"] if entry["id"] == record), None)
    if entry is None or Path(entry["file"]).is_file():
        return
    raise FileNotFoundError(
        f"{entry['file']}, the file of {record}, is not there: paths that are not absolute hold in the working "
        "directory, or in a folder above the results"
    )


def on_stretch(
    frequency_hz: float, impacts: Sequence[Tuple[float, float]], measured: Mapping[str, Signal]
) -> Array:
    """Times of impacts on the axis of a waveform: those that are within it.

    Args:
        frequency_hz: the drive's frequency.
        impacts: of each impact the time from the start of the record, s, and the drive's phase, rad.
        measured: the measured channels.
    """
    ends = [float(signal.time_s[-1]) for signal in measured.values() if len(signal.time_s)]
    if not impacts or not ends:
        return np.zeros(0)
    time_s, phase_rad = impacts[0]
    # the axis begins where the drive first passes the zero phase
    turns_at_0 = (phase_rad / math.tau - frequency_hz * time_s) % 1.0
    begin_s = (1.0 - turns_at_0) / frequency_hz
    times_s = np.array([time for time, _ in impacts], dtype=np.float64) - begin_s
    return times_s[(times_s >= 0.0) & (times_s <= max(ends))]
