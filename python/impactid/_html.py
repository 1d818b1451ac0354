"""Results as a piece of HTML for notebooks.

Colours and fonts are those of the page around it, so that it is readable on light and on dark ones.
"""

from __future__ import annotations

from html import escape
from typing import Any, Mapping, Sequence

from ._estimate import PARAMETERS, Estimate, estimates, interval_text, value_text

_LEFT = 'style="text-align:left"'

#: Names of the methods as the report prints them.
METHODS = {
    "boundaries": "Boundaries",
    "multiple_shooting": "Multiple shooting",
    "flight_times": "Flight times or heights",
    "free_decay": "Free decay",
    "speeds_at_impact": "Speeds at impact",
    "published_speeds": "Published speeds",
    "resonance_curve": "Resonance curve",
    "trajectories": "Trajectories",
}


def method_name(method: str) -> str:
    """The name of a method in words."""
    return METHODS.get(method, method.replace("_", " ").capitalize())


def _row(cells: Sequence[str], kind: str = "td") -> str:
    return "<tr>" + "".join(f"<{kind} {_LEFT}>{cell}</{kind}>" for cell in cells) + "</tr>"


def estimates_table(found: Mapping[str, Estimate]) -> str:
    """A row for each parameter: value, interval, status, note."""
    noted = any(estimate.note for estimate in found.values())
    heads = ["parameter", "value", "95 % interval", "status"] + (["note"] if noted else [])
    rows = [_row(heads, "th")]
    for name, estimate in found.items():
        look = PARAMETERS[name]
        cells = [
            f'<span title="{escape(look.name)}">{look.symbol}</span>',
            escape(value_text(name, estimate)),
            escape(interval_text(name, estimate)),
            escape(estimate.status.replace("_", " ")),
        ]
        rows.append(_row(cells + ([escape(estimate.note or "")] if noted else [])))
    return f"<table>{''.join(rows)}</table>"


def methods_table(methods: Mapping[str, Mapping[str, Estimate]]) -> str:
    """A row for each method, a column for each parameter that one of them gives."""
    names = [name for name in PARAMETERS if any(name in found for found in methods.values())]
    rows = [_row(["method", *(PARAMETERS[name].symbol for name in names)], "th")]
    for method, found in methods.items():
        cells = [escape(_of_method(name, found)) for name in names]
        rows.append(_row([escape(method_name(method)), *cells]))
    return f"<table>{''.join(rows)}</table>"


def _of_method(name: str, found: Mapping[str, Estimate]) -> str:
    estimate = found.get(name)
    if estimate is None:
        return "–"
    weak = " (weak)" if estimate.status == "weak" else ""
    return value_text(name, estimate) + weak


def answer(found: Mapping[str, Any]) -> str:
    """Parameters, findings and methods of an identification: that of a campaign, or of one specimen."""
    of_methods = {name: estimates(result) for name, result in found["methods"].items()}
    texts = [str(finding["text"]) for finding in found["verdict"]["findings"]]
    parts = [estimates_table(estimates(found["joint"]))]
    if texts:
        parts.append(_details(f"Findings ({len(texts)})", items(texts), " open"))
    if len(of_methods) > 1:
        parts.append(_details(str(found["agreement"]["summary"]), methods_table(of_methods)))
    return "".join(parts)


def _details(summary: str, content: str, opened: str = "") -> str:
    """Content that is shown when its summary is clicked, or at once."""
    return f"<details{opened}><summary>{escape(summary)}</summary>{content}</details>"


def items(texts: Sequence[str]) -> str:
    """Texts as a list."""
    return "<ul>" + "".join(f"<li>{escape(text)}</li>" for text in texts) + "</ul>"


def results(found: Mapping[str, Any], folder: str) -> str:
    """What identification.json holds: the verdict, then the answer, or that of each specimen."""
    name = str(found.get("settings", {}).get("name") or folder)
    parts = [f"<strong>{escape(name)}</strong>", f"<p>{escape(found['verdict']['summary'])}</p>"]
    specimens = found.get("specimens", {})
    if not specimens:
        return f"<div>{''.join(parts)}{answer(found)}</div>"
    # what was found of all of them begins with a sentence on each
    parts.append(items([str(finding["text"]) for finding in found["verdict"]["findings"]]))
    for specimen, one in specimens.items():
        parts.append(f"<p><strong>{escape(specimen)}</strong></p>{answer(one)}")
    return f"<div>{''.join(parts)}</div>"
