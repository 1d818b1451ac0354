"""Tables as frames of polars or pandas, whichever is installed."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

_REMEDY = "install one: pip install polars, or pip install pandas pyarrow"


def library(name: str | None) -> Any:
    """The library of a name; without a name polars, else pandas.

    Raises:
        ImportError: with the remedy, where it is not installed.
        ValueError: for another name.
    """
    if name not in (None, "polars", "pandas"):
        raise ValueError(f"frames are of polars or pandas, not of {name!r}")
    for candidate in [name] if name else ["polars", "pandas"]:
        try:
            return importlib.import_module(candidate)
        except ImportError:
            continue
    wanted = name or "polars or pandas"
    raise ImportError(f"{wanted} is not installed; {_REMEDY}")


def parquet(path: Path, name: str | None) -> Any:
    """A Parquet table as a frame."""
    return library(name).read_parquet(path)


def csv(path: Path, name: str | None) -> Any:
    """A CSV table as a frame; lines that begin with # are comments."""
    tables = library(name)
    if tables.__name__ == "polars":
        # a column may hold numbers first and text later
        return tables.read_csv(path, comment_prefix="#", infer_schema_length=None)
    return tables.read_csv(path, comment="#")
