"""Campaigns: run the program on one, read what it found."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Tuple, Union

from . import _frames
from ._program import start

StrPath = Union[str, "PathLike[str]"]

PARAMETERS = (
    "restitution",
    "natural_frequency_hz",
    "damping_ratio",
    "static_deflection_m",
)


@dataclass(frozen=True)
class Estimate:
    """One parameter, SI.

    Attributes:
        value: best value; None where it is not identifiable.
        standard_error: its standard error.
        interval95: the 95 % interval, low and high.
        status: identified, weak or not_identifiable.
        note: why weak or not identifiable, in English.
    """

    value: Optional[float]
    standard_error: Optional[float]
    interval95: Optional[Tuple[float, float]]
    status: str
    note: Optional[str] = None

    @classmethod
    def of(cls, found: Mapping[str, Any]) -> "Estimate":
        """From its form in identification.json."""
        interval = found.get("interval95")
        note = found.get("note")
        return cls(
            value=found.get("value"),
            standard_error=found.get("standard_error"),
            interval95=(interval[0], interval[1]) if interval else None,
            status=found["status"],
            note=note.get("text") if note else None,
        )


def _estimates(found: Mapping[str, Any]) -> dict[str, Estimate]:
    return {name: Estimate.of(found[name]) for name in PARAMETERS if found.get(name)}


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
        path = self.folder / "identification.json"
        if not path.is_file():
            raise FileNotFoundError(
                f"{path} is missing: run `impactid run CAMPAIGN.TOML --out {self.folder}` first"
            )
        #: identification.json as it is.
        self.identification: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))

    def __repr__(self) -> str:
        return f"Results({str(self.folder)!r}: {self.verdict})"

    @property
    def verdict(self) -> str:
        """identified, weak, not_identifiable or does_not_fit."""
        return self.identification["verdict"]["kind"]

    @property
    def summary(self) -> str:
        """The verdict in sentences."""
        return self.identification["verdict"]["summary"]

    @cached_property
    def joint(self) -> dict[str, Estimate]:
        """The joint estimates by parameter: R, f0, β, x_st as far as they were asked for."""
        return _estimates(self.identification["joint"])

    @cached_property
    def methods(self) -> dict[str, dict[str, Estimate]]:
        """The estimates of each method alone, by method and parameter."""
        found = self.identification["methods"].items()
        return {method: _estimates(result) for method, result in found}

    @cached_property
    def specimens(self) -> dict[str, dict[str, Estimate]]:
        """The joint estimates of each specimen, where the campaign holds several."""
        found = self.identification.get("specimens", {}).items()
        return {name: _estimates(result["joint"]) for name, result in found}

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
        if name not in self.figures:
            known = ", ".join(self.figures) or "none"
            raise FileNotFoundError(f"no figure is named {name!r}; there are: {known}")
        return self._table(f"figures/{name}.csv")

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
) -> Results:
    """Run all stages on a campaign, from campaign.toml to the report.

    Args:
        campaign: the campaign's description, campaign.toml.
        out: folder for the results; created if it does not exist.
        formats: of the report, any of pdf, html, svg, png, figure-pdf, tex.
        resume: resume an interrupted run in `out`.
        threads: number of threads; all processors if it is not given.
        frames: see Results.

    Returns:
        The results, also where the answer is "does not fit" or "not identifiable": see `verdict`.

    Raises:
        ProgramError: with the program's message, for bad input.
    """
    arguments = ["--quiet", "run", str(campaign), "--out", str(out)]
    arguments += ["--format", ",".join(formats)] if formats else []
    arguments += ["--resume"] if resume else []
    arguments += ["--threads", str(threads)] if threads else []
    start(arguments, accept=(0, 1))
    return Results(out, frames)
