"""Campaigns: run the program on one, read what it found."""

from __future__ import annotations

import gzip
import json
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np

from . import _frames, _html, _plots, _waveform
from ._estimate import Estimate, estimates
from ._program import start
from ._waveform import Waveform

if TYPE_CHECKING:
    from matplotlib.axes import Axes

StrPath = Union[str, "PathLike[str]"]


class Results:
    """What `impactid run` left in a folder.

    Args:
        folder: the results' folder.
        frames: "polars" or "pandas"; the one that is installed if it is not given.

    Raises:
        FileNotFoundError: where the folder holds no results.
    """

    def __init__(self, folder: StrPath, frames: Optional[str] = None) -> None:
        self.folder = Path(folder)
        self._frames = frames
        self._waveforms: dict[str, Waveform] = {}
        path = self.folder / "identification.json"
        if not path.is_file():
            raise FileNotFoundError(
                f"{path} is missing: run `impactid run CAMPAIGN.TOML --out {self.folder}` first"
            )
        #: identification.json as it is.
        self.identification: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))

    def __repr__(self) -> str:
        return f"Results({str(self.folder)!r}: {self.verdict})"

    def _repr_html_(self) -> str:
        """The answer for notebooks: the verdict, the parameters, the findings, the methods."""
        return _html.results(self.identification, str(self.folder))

    @property
    def verdict(self) -> str:
        """identified, weak, not_identifiable or does_not_fit."""
        return str(self.identification["verdict"]["kind"])

    @property
    def summary(self) -> str:
        """The verdict in sentences."""
        return str(self.identification["verdict"]["summary"])

    @property
    def findings(self) -> list[str]:
        """What was found about the rig and the records, in English sentences; empty where nothing was."""
        return [str(finding["text"]) for finding in self.identification["verdict"]["findings"]]

    @property
    def agreement(self) -> str:
        """Whether the methods agree, in sentences."""
        return str(self.identification["agreement"]["summary"])

    @cached_property
    def joint(self) -> dict[str, Estimate]:
        """The joint estimates by parameter: R, f0, β, x_st as far as they were asked for."""
        return estimates(self.identification["joint"])

    @cached_property
    def methods(self) -> dict[str, dict[str, Estimate]]:
        """The estimates of each method alone, by method and parameter."""
        found = self.identification["methods"].items()
        return {method: estimates(result) for method, result in found}

    @cached_property
    def specimens(self) -> dict[str, dict[str, Estimate]]:
        """The joint estimates of each specimen, where the campaign holds several."""
        found = self.identification.get("specimens", {}).items()
        return {name: estimates(result["joint"]) for name, result in found}

    @cached_property
    def budget(self) -> Any:
        """The uncertainty budget as a frame: a row for each source and parameter."""
        return self._table("uncertainty_budget.csv")

    @cached_property
    def records(self) -> Any:
        """A frame with a row for each record: setting, motion, evidence, flags."""
        return self._table("records.parquet")

    @cached_property
    def impacts(self) -> Any:
        """A frame with a row for each impact."""
        return self._table("impacts.parquet")

    @cached_property
    def brackets(self) -> Any:
        """A frame with a row for each bracket of a boundary."""
        return self._table("boundaries.csv")

    @property
    def figures(self) -> list[str]:
        """Names of the figures whose data are there."""
        return sorted(path.stem for path in (self.folder / "figures").glob("*.csv"))

    def figure(self, name: str) -> Any:
        """The data of a figure as a frame.

        Raises:
            FileNotFoundError: naming the figures that there are.
        """
        return _frames.csv(self._figure_path(name), self._frames)

    def waveform(self, record: str) -> Waveform:
        """The waveform of a record, measured and simulated: the program replays it, which takes seconds.

        Raises:
            ValueError: where no record has this name, or it has no drive.
            FileNotFoundError: where its file is not found.
        """
        if record not in self._waveforms:
            self._waveforms[record] = self._replayed(record)
        return self._waveforms[record]

    def plot_map(self, *, dimensionless: bool = False, ax: "Optional[Axes]" = None) -> "Axes":
        """Plot the map: records by motion, brackets, and the simulated boundaries with their 95 % bands.

        The boundaries are those of the identified parameters.

        Args:
            dimensionless: plot ρ against η; else the clearance in mm against the frequency in Hz.
            ax: axes of matplotlib to draw on; new ones if they are not given.

        Raises:
            ImportError: where matplotlib is not installed.
            FileNotFoundError: where the results hold no map.
        """
        values = {name: estimate.value for name, estimate in self.joint.items()}
        scales = (values.get("natural_frequency_hz"), values.get("static_deflection_m"))
        plane = _plots.Plane(dimensionless, *scales)
        return _plots.draw_map(self._figure_path("map"), plane, ax)

    def plot_residuals(self, method: Optional[str] = None, *, ax: "Optional[Axes]" = None) -> "Axes":
        """Plot the residuals over their standard errors against the drive's frequency.

        Args:
            method: resonance_curve, trajectories or speeds_at_impact; all if it is not given. Of more than
                4000 residuals of one the results hold every second, third …
            ax: axes of matplotlib to draw on; new ones if they are not given.

        Raises:
            ImportError: where matplotlib is not installed.
            ValueError: naming the methods that have residuals.
        """
        found = self._residual_figures()
        chosen = {name: path for name, path in found.items() if method in (None, name)}
        if not chosen:
            known = ", ".join(found) or "none"
            raise ValueError(f"no residuals of {method or 'any method'}; there are those of: {known}")
        return _plots.draw_residuals(chosen, ax)

    def plot_record(
        self, record: str, quantity: Optional[str] = None, *, ax: "Optional[Axes]" = None
    ) -> "Axes":
        """Plot a record: what was measured, what the identified parameters give, and the impacts.

        Args:
            record: its name, as in `records`.
            quantity: velocity, displacement or acceleration; the first that was measured if it is not given.
            ax: axes of matplotlib to draw on; new ones if they are not given.

        Raises:
            ImportError: where matplotlib is not installed.
            ValueError, FileNotFoundError: as `waveform`; also for a quantity that was not measured.
        """
        _plots.pyplot()
        waveform = self.waveform(record)
        return _plots.draw_waveform(waveform, _plots.quantity_of(waveform, quantity), ax)

    def _replayed(self, record: str) -> Waveform:
        frequencies = dict(zip(self.records["record"], self.records["frequency_hz"]))
        if record not in frequencies:
            raise ValueError(f"no record is named {record!r}; see the column record of `records`")
        frequency = frequencies[record]
        if frequency is None or not np.isfinite(frequency):
            raise ValueError(f"{record} has no drive: there is no motion to compare it with")
        found = _waveform.replay(self.folder, record)
        rows = zip(*(self.impacts[name] for name in ("record", "time_s", "drive_phase_rad")))
        impacts = [(time, phase) for name, time, phase in rows if name == record]
        times_s = _waveform.on_stretch(float(frequency), impacts, found["measured"])
        return Waveform(record, found["measured"], found["simulated"], times_s)

    def _residual_figures(self) -> dict[str, Path]:
        """The data of the figures of residuals by method; they are numbered in the order of the fit."""
        # of a run, or of the stages
        of_run, of_stages = self.folder / "report_data.json.gz", self.folder / "residuals.json.gz"
        sets: list[dict[str, Any]] = []
        if of_run.is_file():
            sets = json.loads(gzip.decompress(of_run.read_bytes()))[1]
        elif of_stages.is_file():
            sets = json.loads(gzip.decompress(of_stages.read_bytes()))
        figures = self.folder / "figures"
        found = {str(one["method"]): figures / f"residuals_{i}.csv" for i, one in enumerate(sets, 1)}
        return {method: path for method, path in found.items() if path.is_file()}

    def _figure_path(self, name: str) -> Path:
        if name not in self.figures:
            known = ", ".join(self.figures) or "none"
            raise FileNotFoundError(f"no figure is named {name!r}; there are: {known}")
        return self.folder / "figures" / f"{name}.csv"

    def _table(self, name: str) -> Any:
        path = self.folder / name
        if not path.is_file():
            raise FileNotFoundError(
                f"{path} is missing: these results have none, or come from `impactid identify` alone"
            )
        read = _frames.parquet if path.suffix == ".parquet" else _frames.csv
        return read(path, self._frames)


def run(
    campaign: StrPath,
    out: StrPath,
    *,
    formats: Sequence[str] = ("pdf",),
    resume: bool = False,
    threads: Optional[int] = None,
    frames: Optional[str] = None,
    title: Optional[str] = None,
    language: Optional[str] = None,
    paper: Optional[str] = None,
    decimal_comma: bool = False,
    template: Optional[StrPath] = None,
    words: Optional[StrPath] = None,
    logo: Optional[StrPath] = None,
) -> Results:
    """Run all stages on a campaign, from campaign.toml to the report.

    Args:
        campaign: the campaign's description, campaign.toml.
        out: folder for the results; created if it does not exist.
        formats: of the report, any of pdf, html, svg, png, figure-pdf, tex.
        resume: resume an interrupted run in `out`.
        threads: number of threads; all processors if it is not given.
        frames: see Results.
        title, language, paper, decimal_comma, template, words, logo: of the report, instead of what campaign.toml
            states under [report].

    Returns:
        The results, also where the answer is "does not fit" or "not identifiable": see `verdict`.

    Raises:
        ProgramError: with the program's message, for bad input.
    """
    arguments = ["--quiet", "run", str(campaign), "--out", str(out)]
    arguments += ["--format", ",".join(formats)] if formats else []
    arguments += ["--resume"] if resume else []
    arguments += ["--threads", str(threads)] if threads else []
    report: "dict[str, Optional[StrPath]]" = {"title": title, "language": language, "paper": paper}
    report |= {"template": template, "words": words, "logo": logo}
    arguments += [f"--{name}={value}" for name, value in report.items() if value is not None]
    arguments += ["--decimal-comma"] if decimal_comma else []
    start(arguments, accept=(0, 1))
    return Results(out, frames)
