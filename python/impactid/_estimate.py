"""Estimates, and how parameters and their numbers are printed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Mapping, Optional, Tuple


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


@dataclass(frozen=True)
class Look:
    """How a parameter is printed.

    Attributes:
        name: its name in words.
        symbol: its symbol as HTML.
        unit: its unit as printed; empty where it has none.
        factor: printed value over SI value.
    """

    name: str
    symbol: str
    unit: str = ""
    factor: float = 1.0


#: The parameters by their names in identification.json, in the order of the report.
PARAMETERS = {
    "restitution": Look("coefficient of restitution", "R"),
    "natural_frequency_hz": Look("natural frequency", "f<sub>0</sub>", "Hz"),
    "damping_ratio": Look("damping ratio", "β"),
    "static_deflection_m": Look("static deflection", "x<sub>st</sub>", "mm", 1e3),
}


def estimates(found: Mapping[str, Any]) -> dict[str, Estimate]:
    """The parameters that an object of identification.json holds."""
    return {name: Estimate.of(found[name]) for name in PARAMETERS if found.get(name)}


def decimals_for(uncertainty: float) -> int:
    """Decimals at which an uncertainty shows two significant digits, as in the report."""
    if not (math.isfinite(uncertainty) and uncertainty > 0.0):
        return 4
    exponent = math.floor(math.log10(uncertainty))
    # 0.00996 is 0.010 in two digits
    exponent += round(uncertainty / 10.0 ** (exponent - 1)) >= 100
    return min(max(1 - exponent, 0), 9)


def fixed(value: float, decimals: int) -> str:
    """A number with decimals and a true minus; zero has no sign."""
    text = f"{value:.{decimals}f}"
    return text.replace("-", "\u2212" if text.strip("-0.") else "")


def _decimals(estimate: Estimate, look: Look) -> int:
    half = 0.0
    if estimate.interval95 is not None:
        half = 0.5 * (estimate.interval95[1] - estimate.interval95[0])
    elif estimate.standard_error is not None:
        half = 1.96 * estimate.standard_error
    return decimals_for(half * look.factor)


def _with_unit(text: str, look: Look) -> str:
    return f"{text}\u2009{look.unit}" if look.unit else text


def value_text(name: str, estimate: Estimate) -> str:
    """`value ± half of the 95 % interval` with unit, as the report prints it."""
    if estimate.value is None:
        return "not identifiable"
    look = PARAMETERS[name]
    decimals = _decimals(estimate, look)
    text = fixed(estimate.value * look.factor, decimals)
    if estimate.interval95 is not None:
        half = 0.5 * (estimate.interval95[1] - estimate.interval95[0])
        text += f" ± {fixed(half * look.factor, decimals)}"
    elif estimate.standard_error is not None:
        text += f" ± {fixed(1.96 * estimate.standard_error * look.factor, decimals)}"
    return _with_unit(text, look)


def interval_text(name: str, estimate: Estimate) -> str:
    """The 95 % interval with unit; a dash where there is none."""
    if estimate.interval95 is None:
        return "–"
    look = PARAMETERS[name]
    decimals = _decimals(estimate, look)
    low, high = (fixed(end * look.factor, decimals) for end in estimate.interval95)
    return _with_unit(f"{low} … {high}", look)
