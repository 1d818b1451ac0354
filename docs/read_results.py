"""Read every output of `impactid run` with polars or pandas, and plot the map of the records.

    python docs/read_results.py results/

It requires polars (or pandas with pyarrow); with matplotlib it also writes results/records.png.
"""

import json
import sys
from pathlib import Path

try:
    import polars as tables
except ImportError:
    import pandas as tables


def columns(table, *names):
    """Columns as lists, with either library."""
    return [list(table[name]) for name in names]


def answer(folder):
    """R, f0, β and x_st with their intervals, from identification.json."""
    identification = json.loads((folder / "identification.json").read_text())
    print(identification["verdict"]["summary"])
    for name, estimate in identification["joint"].items():
        if isinstance(estimate, dict) and "status" in estimate:
            print(f"  {name}: {estimate['value']} {estimate['interval95']} {estimate['status']}")
    return identification


def read(folder):
    """Every table: the records, their impacts, the boundaries, the data of each figure."""
    found = {
        "records": tables.read_parquet(folder / "records.parquet"),
        "impacts": tables.read_parquet(folder / "impacts.parquet"),
        "boundaries": tables.read_csv(folder / "boundaries.csv"),
    }
    for path in sorted((folder / "figures").glob("*.csv")):
        # comments begin with #; a column may contain numbers and text
        if tables.__name__ == "polars":
            found[path.stem] = tables.read_csv(path, comment_prefix="#", infer_schema_length=None)
        else:
            found[path.stem] = tables.read_csv(path, comment="#")
    return found


def plot(records, path):
    """Each record at its frequency and clearance, coloured by its motion z = p/n."""
    try:
        import matplotlib
    except ImportError:
        print("matplotlib is not installed: no plot")
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot

    frequency, clearance, motion = columns(records, "frequency_hz", "clearance_m", "motion")
    for kind in sorted(set(motion)):
        points = [(f, 1e3 * c) for f, c, m in zip(frequency, clearance, motion)
                  if m == kind and f is not None and c is not None]
        if points:
            pyplot.plot(*zip(*points), ".", label=f"z = {kind}")
    pyplot.xlabel("drive frequency, Hz")
    pyplot.ylabel("clearance, mm")
    pyplot.legend()
    pyplot.savefig(path)
    print(f"written: {path}")


def main():
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "results")
    answer(folder)
    found = read(folder)
    for name, table in found.items():
        print(f"{name}: {table.shape[0]} rows, columns {', '.join(map(str, table.columns))}")
    resolved = json.loads((folder / "campaign.resolved.json").read_text())
    print(f"campaign.resolved.json: {len(resolved['records'])} records")
    plot(found["records"], folder / "records.png")


if __name__ == "__main__":
    main()
