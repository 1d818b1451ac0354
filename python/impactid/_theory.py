"""The theory: motions and boundaries as numpy arrays."""

from __future__ import annotations

import json
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Iterable, Optional, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._columns import Array, columns, numbers
from ._program import start


@dataclass(frozen=True)
class Motion:
    """A simulated motion, dimensionless: displacements over x_st, velocities over x_st Ω.

    Attributes:
        tau_over_period: time in drive periods.
        x, x_velocity, y, y_velocity: the masses; y is positive toward x.
        joined: whether the masses are together.
        impacts: the impacts, one array for each column of motion-impacts.csv that holds numbers.
    """

    tau_over_period: Array
    x: Array
    x_velocity: Array
    y: Array
    y_velocity: Array
    joined: NDArray[np.bool_]
    impacts: dict[str, Array]


@dataclass(frozen=True)
class Boundary:
    """Points of a boundary in the plane of η and ρ.

    Attributes:
        eta, rho: the points; the one that was sought is NaN where the motion has no such boundary. Of
            several η at one ρ, or several ρ at one η, only the first is given.
        valid: whether a machine shows the boundary there.
    """

    eta: Array
    rho: Array
    valid: NDArray[np.bool_]


def _machine(
    restitution: float, damping_ratio: float, single: bool, options: dict[str, float]
) -> list[str]:
    arguments = [f"--restitution={restitution!r}", f"--damping-ratio={damping_ratio!r}"]
    arguments += ["--single"] if single else []
    known = ("drive_ratio", "stiffness_ratio", "mass_ratio")
    for name, value in options.items():
        if name not in known:
            raise TypeError(f"a machine has no {name!r}; it has {', '.join(known)}")
        arguments.append(f"--{name.replace('_', '-')}={value!r}")
    return arguments


def simulate(
    *,
    eta: float,
    rho: float,
    restitution: float = 0.9,
    damping_ratio: float = 0.07,
    periods: float = 10.0,
    skip_periods: float = 0.0,
    samples_per_period: int = 200,
    phase: float = 0.0,
    start_state: Optional[Tuple[float, ...]] = None,
    single: bool = False,
    **machine: float,
) -> Motion:
    """Simulate a motion exactly.

    Args:
        eta: frequency ratio η.
        rho: clearance ρ.
        restitution: R.
        damping_ratio: β.
        periods: drive periods of the time series.
        skip_periods: drive periods that pass before it.
        samples_per_period: samples of the time series in a drive period.
        phase: phase of the drive at the start, rad.
        start_state: X, X' or X, X', Y, Y' at the start; at rest if it is not given.
        single: one mass against a stop instead of two against each other.
        machine: drive_ratio, stiffness_ratio, mass_ratio of y over x.

    Raises:
        ProgramError: where a value is out of the model's range.
    """
    arguments = ["--quiet", "simulate", f"--eta={eta!r}", f"--rho={rho!r}", f"--phase={phase!r}"]
    arguments += _machine(restitution, damping_ratio, single, machine)
    arguments += [f"--periods={periods!r}", f"--skip-periods={skip_periods!r}"]
    arguments += [f"--samples-per-period={samples_per_period}", "--poincare-periods=0"]
    if start_state is not None:
        arguments.append("--start=" + ",".join(repr(float(v)) for v in start_state))
    with tempfile.TemporaryDirectory(prefix="impactid-") as folder:
        start([*arguments, "--out", folder])
        motion = columns(Path(folder) / "motion.csv")
        impacts = columns(Path(folder) / "motion-impacts.csv")
    found = {name: numbers(column) for name, column in impacts.items()}

    def of(name: str) -> Array:
        series = numbers(motion.get(name, []))
        return np.zeros(0) if series is None else series

    return Motion(
        tau_over_period=of("tau_over_period"),
        x=of("x"),
        x_velocity=of("x_velocity"),
        y=of("y"),
        y_velocity=of("y_velocity"),
        joined=np.array([cell == "true" for cell in motion.get("joined", [])], dtype=np.bool_),
        impacts={name: column for name, column in found.items() if column is not None},
    )


#: Kinds of boundaries.
_KINDS = ("s2", "s1", "grazing", "further-impact", "dead-zone", "joined")


def boundary(
    kind: str,
    *,
    motion: Optional[str] = None,
    eta: Union[None, float, Iterable[float]] = None,
    rho: Union[None, float, Iterable[float]] = None,
    restitution: float = 0.9,
    damping_ratio: float = 0.07,
    single: bool = False,
    **machine: float,
) -> Boundary:
    """Points of a boundary of a motion: ρ at given η, or η at given ρ.

    Args:
        kind: s2 (saddle-node), s1 (period doubling), grazing, further-impact, dead-zone or joined.
        motion: the motion z = p/n that it bounds, 1/1 if it is not given. grazing (which bounds z = 0) and
            joined take none.
        eta: one frequency ratio or several, or
        rho: one clearance or several.
        restitution, damping_ratio, single, machine: as for simulate.

    Raises:
        ValueError: unless exactly one of eta and rho is given, and for a kind that does not exist.
        ProgramError: for a motion that does not exist.
    """
    if (eta is None) == (rho is None):
        raise ValueError("give either eta or rho")
    if kind not in _KINDS:
        raise ValueError(f"kind is one of {', '.join(_KINDS)}, not {kind!r}")
    name, given = ("eta", eta) if eta is not None else ("rho", rho)
    values = np.atleast_1d(np.asarray(given, dtype=np.float64))
    arguments = ["--quiet", "boundary", f"--kind={kind}", "--json"]
    arguments += [] if motion is None else [f"--motion={motion}"]
    arguments += _machine(restitution, damping_ratio, single, machine)
    found = [_point(arguments, name, value) for value in values]
    return Boundary(
        eta=np.array([point[0] for point in found], dtype=np.float64),
        rho=np.array([point[1] for point in found], dtype=np.float64),
        valid=np.array([point[2] for point in found], dtype=np.bool_),
    )


def _point(arguments: Sequence[str], name: str, value: float) -> Tuple[float, float, bool]:
    said = start([*arguments, f"--{name}={float(value)!r}"], accept=(0, 1)).strip()
    point = json.loads(said) if said.startswith("{") else {}
    given = {name: float(value)}

    def number(key: str) -> float:
        found = point.get(key)
        found = given.get(key) if found is None else found
        return float("nan") if found is None else float(found)

    return number("eta"), number("rho"), bool(point.get("valid", False))
