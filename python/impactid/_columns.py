"""CSV tables of the program as columns, without a library of frames."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Optional, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def columns(path: Path) -> dict[str, list[str]]:
    """The columns of a table as text, by their heads; lines that begin with # are comments."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        names = list(rows[0]) if rows else []
    return {name: [row[name] for row in rows] for name in names}


def numbers(column: Sequence[str]) -> Optional[Array]:
    """A column as numbers, NaN where a cell is empty; None where a cell is text."""
    try:
        return np.array([float(cell) if cell else np.nan for cell in column], dtype=np.float64)
    except ValueError:
        return None
