"""Results as plots of matplotlib, which is imported when one is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Tuple

import numpy as np

from ._columns import Array, columns, numbers
from ._html import method_name
from ._waveform import Signal, Waveform

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_BLUE, _VERMILION, _GREEN, _QUIET = "#005fa3", "#d55e00", "#008a66", "#5f666d"
_ORANGE, _SKY, _PURPLE, _PLUM = "#c98600", "#2f9bd8", "#b0528a", "#6f4a9e"
_BROWN, _DARK_RED, _SLATE, _UNUSED = "#7a5030", "#8c1d1d", "#444a50", "#9aa0a5"

#: Mark and colour of each motion, as in the report; the order is that of the legend.
_MOTIONS = {
    "0": ("o", _SLATE),
    "1": ("o", _BLUE),
    "1j": ("o", _SKY),
    "2/1": ("^", _GREEN),
    "1/2": ("s", _VERMILION),
    "2/2": ("s", _ORANGE),
    "1/3": ("D", _PURPLE),
    "1/4": ("v", _PLUM),
    "1/5": ("*", _BROWN),
    "beat": ("P", _BROWN),
    "chaotic": ("X", _DARK_RED),
    "joined": ("_", _UNUSED),
    "undetermined": (".", _UNUSED),
}
_OTHER_MOTION = ("d", _PLUM)
_OPEN_MARKS = ("0", "2/2")

_LINES = {"s2": "-", "s1": "--", "grazing": ":", "edge": "-."}
_BOUNDARIES = {"s2": "$s_2$", "s1": "$s_1$", "grazing": "grazing", "edge": "edge"}
_METHODS = {"resonance_curve": _BLUE, "trajectories": _GREEN, "speeds_at_impact": _VERMILION}

#: Quantities of a waveform in the order in which one is chosen, with printed unit and factor.
_QUANTITIES = {
    "velocity": ("mm/s", 1e3),
    "displacement": ("mm", 1e3),
    "acceleration": ("m/s²", 1.0),
}


def pyplot() -> Any:
    """matplotlib's pyplot.

    Raises:
        ImportError: with the remedy, where it is not installed.
    """
    try:
        from matplotlib import pyplot as found
    except ImportError as error:
        raise ImportError(
            "matplotlib is not installed; install it: pip install impactid[plot], or pip install matplotlib"
        ) from error
    return found


def _axes(given: "Optional[Axes]", size: Tuple[float, float]) -> "Axes":
    if given is not None:
        return given
    made: "Axes" = pyplot().subplots(figsize=size, layout="constrained")[1]
    return made


@dataclass(frozen=True)
class Plane:
    """The plane of a map.

    Attributes:
        dimensionless: whether it is that of η and ρ; else frequency in Hz and clearance in mm.
        natural_frequency_hz, static_deflection_m: what turns one into the other; None where not identified.
    """

    dimensionless: bool
    natural_frequency_hz: Optional[float]
    static_deflection_m: Optional[float]

    def measured(self, table: Mapping[str, Array], end: str = "") -> Tuple[Array, Array]:
        """Places of records or of a bracket's ends; end is "" or "_high"."""
        if self.dimensionless:
            return table[f"eta{end}"], table["rho"]
        frequency = table["frequency_high_hz" if end else "frequency_hz"]
        return frequency, 1e3 * table["clearance_m"]

    def simulated(self, eta: Array, rho: Array) -> Optional[Tuple[Array, Array]]:
        """Places of what was simulated; None where they are not known in this plane."""
        if self.dimensionless:
            return eta, rho
        if self.natural_frequency_hz is None or self.static_deflection_m is None:
            return None
        return eta * self.natural_frequency_hz, rho * 1e3 * self.static_deflection_m

    def label(self, axes: "Axes") -> None:
        """Titles of the axes."""
        if self.dimensionless:
            axes.set(xlabel="frequency ratio $η$", ylabel="clearance $ρ$")
        else:
            axes.set(xlabel="drive frequency, Hz", ylabel="clearance, mm")


_NUMBERS = (
    "eta",
    "rho",
    "frequency_hz",
    "clearance_m",
    "eta_high",
    "rho_high",
    "frequency_high_hz",
)


@dataclass(frozen=True)
class Layer:
    """Rows of one layer of a map's data: their places in the table, texts and numbers by column."""

    places: list[int]
    names: list[str]
    motions: list[str]
    sweeps: list[str]
    values: dict[str, Array]

    def rows(self, chosen: Sequence[int]) -> dict[str, Array]:
        """The numbers of some rows."""
        return {name: column[list(chosen)] for name, column in self.values.items()}


def _layer(table: Mapping[str, list[str]], layer: str) -> Layer:
    at = [i for i, name in enumerate(table.get("layer", [])) if name == layer]

    def texts(name: str) -> list[str]:
        return [table[name][i] for i in at]

    found = {name: numbers(texts(name)) for name in _NUMBERS}
    values = {name: np.zeros(0) if column is None else column for name, column in found.items()}
    return Layer(at, texts("name"), texts("motion"), texts("sweep"), values)


def draw_map(path: Path, plane: Plane, given: "Optional[Axes]") -> "Axes":
    """Records by motion, brackets, and the boundaries that the identified parameters give."""
    axes = _axes(given, (8.0, 5.0))
    table = columns(path)
    records, brackets = _layer(table, "record"), _layer(table, "bracket")
    _records(axes, records, plane)
    _brackets(axes, brackets, plane)
    # what is simulated beyond the records does not widen the axes
    for x, y in (plane.measured(records.values), plane.measured(brackets.values, "_high")):
        there = np.isfinite(x) & np.isfinite(y)
        axes.update_datalim(np.column_stack([x[there], y[there]]))
    axes.autoscale_view()
    axes.set(xlim=axes.get_xlim(), ylim=axes.get_ylim())
    _curves(axes, _layer(table, "curve"), plane)
    _bands(axes, _layer(table, "band95"), plane)
    plane.label(axes)
    _legend_beside(axes, "upward sweeps above,\ndownward ones below")
    return axes


def _in_order(motions: Sequence[str]) -> list[str]:
    known = list(_MOTIONS)
    place = {name: i for i, name in enumerate(known[:9])}
    last = {name: 100 + i for i, name in enumerate(known[9:])}
    return sorted(set(motions), key=lambda name: ({**place, **last}.get(name, 50), name))


#: How far marks of upward sweeps are above their clearance, those of downward sweeps below, points.
_LIFT = {"up": 2.5, "down": -2.5}


def _lifted(axes: "Axes", sweep: str) -> Any:
    from matplotlib.transforms import offset_copy

    figure: Any = axes.figure
    return offset_copy(axes.transData, fig=figure, y=_LIFT.get(sweep, 0.0), units="points")


def _records(axes: "Axes", layer: Layer, plane: Plane) -> None:
    x, y = plane.measured(layer.values)
    for motion in _in_order(layer.motions):
        mark, colour = _MOTIONS.get(motion, _OTHER_MOTION)
        label: Optional[str] = f"$z$ = {motion}" if motion[0].isdigit() else motion
        of_motion = [i for i, name in enumerate(layer.motions) if name == motion]
        for sweep in sorted({layer.sweeps[i] for i in of_motion}):
            chosen = [i for i in of_motion if layer.sweeps[i] == sweep]
            axes.plot(
                x[chosen],
                y[chosen],
                mark,
                color=colour,
                markersize=5,
                markerfacecolor="none" if motion in _OPEN_MARKS else colour,
                markeredgewidth=0.9,
                label=label,
                zorder=3,
                transform=_lifted(axes, sweep),
            )
            label = None


def _brackets(axes: "Axes", layer: Layer, plane: Plane) -> None:
    (low, height), (high, _) = plane.measured(layer.values), plane.measured(layer.values, "_high")
    for i, sweep in enumerate(layer.sweeps):
        axes.plot(
            [low[i], high[i]],
            [height[i], height[i]],
            "|-",
            color="black",
            linewidth=1.2,
            markersize=8,
            zorder=4,
            label=None if i else "bracket of a boundary",
            transform=_lifted(axes, sweep),
        )


def _pieces(layer: Layer) -> list[Tuple[str, dict[str, Array]]]:
    """Boundaries one by one: the rows of each follow each other, between those of other layers."""
    places = layer.places
    starts = [i for i in range(len(places)) if i == 0 or places[i] != places[i - 1] + 1]
    ends = [*starts[1:], len(places)]
    return [(layer.names[a], layer.rows(range(a, b))) for a, b in zip(starts, ends)]


def _curves(axes: "Axes", layer: Layer, plane: Plane) -> None:
    named: set[str] = set()
    for name, rows in _pieces(layer):
        place = plane.simulated(rows["eta"], rows["rho"])
        if place is None:
            return
        label = None if name in named else f"simulated {_BOUNDARIES.get(name, name)}"
        named.add(name)
        style = _LINES.get(name, "-.")
        axes.plot(*place, style, color=_QUIET, linewidth=1.2, zorder=2, label=label)


def _bands(axes: "Axes", layer: Layer, plane: Plane) -> None:
    for _, rows in _pieces(layer):
        low = plane.simulated(rows["eta"], rows["rho"])
        high = plane.simulated(rows["eta_high"], rows["rho_high"])
        if low is None or high is None:
            return
        axes.fill_between(low[0], low[1], high[1], color=_QUIET, alpha=0.3, linewidth=0, zorder=1)


def _legend_beside(axes: "Axes", title: str = "") -> None:
    axes.legend(
        loc="center left",
        bbox_to_anchor=(1.01, 0.5),
        frameon=False,
        fontsize="small",
        title=title,
        title_fontsize="small",
    )


def draw_residuals(tables: Mapping[str, Path], given: "Optional[Axes]") -> "Axes":
    """Weighted residuals of methods over the drive's frequency, with the band of 95 %."""
    axes = _axes(given, (8.0, 4.0))
    read = {method: columns(path) for method, path in tables.items()}
    for method in sorted(read, key=lambda name: -len(read[name]["residual"])):
        frequency, residual = numbers(read[method]["frequency_hz"]), numbers(read[method]["residual"])
        if frequency is None or residual is None:
            continue
        colour = _METHODS.get(method, _PLUM)
        outside = float(np.mean(np.abs(residual) > 1.96))
        label = f"{method_name(method)}: {len(residual)}, {100 * outside:.1f} % outside ±1.96"
        axes.plot(frequency, residual, ".", color=colour, markersize=2.5, alpha=0.6, label=label)
    axes.axhline(0.0, color=_QUIET, linewidth=0.8)
    for level in (-1.96, 1.96):
        axes.axhline(level, color=_QUIET, linewidth=0.8, linestyle="--")
    axes.set(xlabel="drive frequency, Hz", ylabel="residual / standard error")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False, fontsize="small")
    return axes


def quantity_of(waveform: Waveform, wanted: Optional[str]) -> str:
    """The quantity to be drawn: the one wanted, else the first that is there.

    Raises:
        ValueError: where the record has none, or not the one that is wanted.
    """
    there = [q for q in _QUANTITIES if _channels(waveform.measured, q)]
    if wanted in there:
        return str(wanted)
    if wanted is None and there:
        return there[0]
    known = ", ".join(there) or "none of velocity, displacement and acceleration"
    raise ValueError(f"{waveform.record} has no measured {wanted or 'motion'}; it has {known}")


def _channels(found: Mapping[str, Signal], quantity: str) -> dict[str, Signal]:
    """The channels of a quantity by mass."""
    return {
        role[-1]: signal for role, signal in found.items() if role.rsplit("_", 1)[0] == quantity
    }


def draw_waveform(waveform: Waveform, quantity: str, given: "Optional[Axes]") -> "Axes":
    """The measured channels of a quantity, the simulated ones, and the impacts."""
    axes = _axes(given, (8.0, 4.0))
    unit, factor = _QUANTITIES[quantity]
    colours = {"x": _BLUE, "y": _VERMILION}
    for mass, signal in _channels(waveform.measured, quantity).items():
        axes.plot(
            1e3 * signal.time_s,
            factor * signal.values,
            ".",
            color=colours.get(mass, _GREEN),
            markersize=6,
            markeredgewidth=0,
            alpha=0.35,
            label=f"{mass} measured",
        )
    for mass, signal in _channels(waveform.simulated, quantity).items():
        line = {"x": "-", "y": "--"}.get(mass, "-.")
        axes.plot(
            1e3 * signal.time_s,
            factor * signal.values,
            line,
            color=colours.get(mass, _GREEN),
            linewidth=1.0,
            label=f"{mass} simulated",
        )
    for i, time in enumerate(waveform.impacts_s):
        label = None if i else "impact, measured"
        axes.axvline(1e3 * time, color=_UNUSED, linewidth=0.8, zorder=0, label=label)
    axes.set(
        xlabel="time from a zero phase of the drive, ms",
        ylabel=f"{quantity}, {unit}",
        title=waveform.record,
    )
    _legend_beside(axes)
    return axes
