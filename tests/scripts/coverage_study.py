#!/usr/bin/env python3
"""How often the answers of impactid hold the truth, on campaigns of the simulated laboratory.

    python coverage_study.py --binary target/release/impactid --kinds typical,rate_20k --campaigns 40 --work DIR

makes the campaigns of each kind (laboratory.py; seeds are counted from --first-seed), runs `ingest`, `classify` and
`identify` on each and prints one table. Campaigns that are in DIR already are used again; results are made anew,
unless --again is given. Needs what laboratory.py needs, and polars.
"""

import argparse
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import polars

import laboratory
from kinds import KINDS

PARAMETERS = {"restitution": "R", "natural_frequency_hz": "f0", "damping_ratio": "β", "static_deflection_m": "x_st"}
GIVEN = ("identified", "weak")
CERTAIN = 0.9


def identified(binary, folder, results):
    """Runs the stages; the exit code of the last one, and seconds."""
    shutil.rmtree(results, ignore_errors=True)
    begin = time.monotonic()
    stages = ([str(folder / "campaign.toml"), "--out", str(results)], [str(results)], [str(results)])
    code = 0
    with open(folder / f"{results.name}.log", "w") as log:
        for stage, arguments in zip(("ingest", "classify", "identify"), stages):
            environment = {**os.environ, "NO_COLOR": "1"}
            run = subprocess.run([binary, stage, *arguments], stdout=log, stderr=log, env=environment, timeout=1800)
            code = run.returncode
            if code not in (0, 1):
                break
    return code, time.monotonic() - begin


def holds(estimate, values):
    """Whether the interval holds one of the values, and how many half widths it misses the nearest by."""
    low, high = estimate["interval95"]
    half = 0.5 * (high - low)
    off = min(abs(v - 0.5 * (low + high)) for v in values)
    return off <= half * (1.0 + 1e-12), off / half if half > 0.0 else math.inf


def scored(estimates, truth):
    """For each parameter: its status, whether it is held, how many half widths off, its relative half width."""
    result = {}
    for name in PARAMETERS:
        estimate = estimates.get(name)
        if not isinstance(estimate, dict) or estimate.get("status") not in GIVEN or not estimate.get("interval95"):
            result[name] = {"status": "none"}
            continue
        values = [t[name] for t in (truth["truth"], truth["alternative"]) if t]
        held, off = holds(estimate, values)
        low, high = estimate["interval95"]
        error = (0.5 * (low + high) - values[0]) / values[0]
        width = 0.5 * (high - low) / values[0]
        result[name] = {"status": estimate["status"], "held": held, "off": off, "error": error, "width": width}
    return result


def label(p, n):
    """The program's label of z = p/n, without the mark of a dead zone."""
    return str(p) if (p, n) in ((0, 1), (1, 1)) else f"{p}/{n}"


def motions(folder, results):
    """Motions right and wrong where the program is certain, and how many it leaves open."""
    count = Counter()
    try:
        table = polars.read_parquet(results / "records.parquet")
    except (OSError, polars.exceptions.PolarsError):
        return count
    found = {str(r["record"]).split("/")[0]: r for r in table.iter_rows(named=True)}
    with open(folder / "truth_motions.csv", newline="") as file:
        for row in csv.DictReader(file):
            record = found.get(row["record"])
            if record is None:
                count["missing"] += 1
                continue
            said, sure = str(record["motion"]).replace("j", ""), (record["confidence"] or 0.0) >= CERTAIN
            if row["impacts_p"] == "":
                periodic = said.replace("/", "").isdigit()
                count["irregular, called periodic" if periodic and sure else "irregular"] += 1
            elif said == label(int(row["impacts_p"]), int(row["periods_n"])):
                count["right" if sure else "right, not certain"] += 1
            elif sure and said not in ("undetermined", "beat", "chaotic"):
                count["wrong"] += 1
            else:
                count["open"] += 1
    return count


def evaluated(folder, results, code, seconds):
    """What one campaign's results say beside its truth."""
    line = {"code": code, "seconds": round(seconds, 1), "motions": dict(motions(folder, results))}
    try:
        answer = json.loads((results / "identification.json").read_text())
    except (OSError, ValueError):
        return {**line, "verdict": "no result", "joint": {}, "methods": {}, "findings": []}
    truth = json.loads((folder / "truth.json").read_text())
    line["verdict"] = answer["verdict"]["kind"]
    line["agree"] = (answer.get("agreement") or {}).get("agree")
    line["joint"] = scored(answer.get("joint") or {}, truth)
    line["methods"] = {name: scored(m or {}, truth) for name, m in (answer.get("methods") or {}).items()}
    line["findings"] = sorted({finding_name(f) for f in answer["verdict"].get("findings", [])})
    return line


def finding_name(finding):
    """A finding's kind, with the parameter, effect or channel that it is about."""
    about = [str(finding[k]) for k in ("effect", "parameter", "channel", "role") if isinstance(finding.get(k), str)]
    return " ".join([finding.get("kind", "?"), *about])


def share(lines, name):
    """How often a parameter is held of how often it is given, how often not given, and the worst miss."""
    given = [s for s in lines if s.get(name, {}).get("status") in GIVEN]
    held = sum(s[name]["held"] for s in given)
    absent = len(lines) - len(given)
    text = f"{held}/{len(given)}"
    if held < len(given):
        text += f" (≤ {max(s[name]['off'] for s in given):.1f})"
    return text + (f", {absent} none" if absent else "")


def median_width(lines, name):
    """Median half width in per cent of the truth."""
    widths = sorted(s[name]["width"] for s in lines if s.get(name, {}).get("status") in GIVEN)
    return f"{100.0 * widths[len(widths) // 2]:.2g}" if widths else "–"


def counted(names):
    """Counts as text, the most frequent first."""
    return ", ".join(f"{name} {n}" for name, n in Counter(names).most_common()) or "–"


def wrong(lines):
    """Parameters called identified whose interval does not hold the truth, and by more than 1.5 half widths."""
    missed = [s for line in lines for s in line["joint"].values() if s["status"] == "identified" and not s["held"]]
    return f"{len(missed)} ({sum(s['off'] > 1.5 for s in missed)})"


def method_shares(lines):
    """R of each method alone."""
    names = sorted({name for line in lines for name in line["methods"]})
    parts = []
    for name in names:
        own = [line["methods"][name] for line in lines if name in line["methods"]]
        own = [s for s in own if s["restitution"]["status"] in GIVEN]
        if own:
            parts.append(f"{name} {share(own, 'restitution')} ± {median_width(own, 'restitution')} %")
    return "; ".join(parts) or "–"


HEAD = (
    "| kind | n | R | f0 | β | x_st | half widths, % | identified but missed (> 1.5) | verdicts | disagree | motions | R of each method"
    " | findings | s |\n" + "|---" * 14 + "|"
)


def row(kind, lines):
    """One row of the table."""
    joint = [line["joint"] for line in lines]
    total = Counter()
    for line in lines:
        total.update(line["motions"])
    widths = ", ".join(median_width(joint, name) for name in PARAMETERS)
    cells = [
        kind,
        str(len(lines)),
        *(share(joint, name) for name in PARAMETERS),
        widths,
        wrong(lines),
        counted(f"{line['verdict']}:{line['code']}" for line in lines),
        str(sum(line.get("agree") is False for line in lines)),
        ", ".join(f"{k} {v}" for k, v in sorted(total.items())),
        method_shares(lines),
        counted(f for line in lines for f in line["findings"]),
        f"{sum(line['seconds'] for line in lines) / max(1, len(lines)):.0f}",
    ]
    return "| " + " | ".join(cells) + " |"


def campaign(kind, seed, given):
    """One campaign of a kind: made, run and scored."""
    folder = Path(given.work) / f"{kind}-{seed}"
    if not (folder / "truth_motions.csv").exists():
        laboratory.make(kind, laboratory.with_settings(laboratory.kind_of(kind, seed), given.set), seed, folder)
    results = folder / given.results
    score = folder / f"{given.results}.json"
    if given.again and score.exists() and (results / "identification.json").exists():
        old = json.loads(score.read_text())
        line = evaluated(folder, results, old["code"], old["seconds"])
    else:
        line = evaluated(folder, results, *identified(given.binary, folder, results))
    score.write_text(json.dumps(line))
    if given.lean and folder.exists():
        (folder / "campaign.h5").unlink(missing_ok=True)
        (folder / "truth_motions.csv").unlink(missing_ok=True)
    return line


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", required=True)
    parser.add_argument("--kinds", default="all", help="names with commas, or all")
    parser.add_argument("--campaigns", type=int, default=40, help="of each kind")
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--work", default="coverage", help="folder of the campaigns and their results")
    parser.add_argument("--results", default="results", help="name of the folder of results in that of a campaign")
    parser.add_argument("--table", help="file that receives the table as well")
    parser.add_argument("--again", action="store_true", help="score results that are there already, without running")
    parser.add_argument("--lean", action="store_true", help="remove each campaign's records once it is scored")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a field of kinds.Kind")
    given = parser.parse_args()
    kinds = list(KINDS) if given.kinds == "all" else given.kinds.split(",")
    unknown = [k for k in kinds if k not in KINDS and k not in laboratory.DRAWN]
    if unknown:
        parser.error(f"no kind {', '.join(unknown)}; laboratory.py --list prints them")
    rows = [HEAD]
    print(HEAD, flush=True)
    for kind in kinds:
        lines = []
        for seed in range(given.first_seed, given.first_seed + given.campaigns):
            lines.append(campaign(kind, seed, given))
            missed = [PARAMETERS[k] for k, s in lines[-1]["joint"].items() if s["status"] == "identified" and not s["held"]]
            print(f"{kind}-{seed}: {lines[-1]['verdict']}, missed {missed}", file=sys.stderr, flush=True)
        rows.append(row(kind, lines))
        print(rows[-1], flush=True)
        if given.table:
            Path(given.table).write_text("\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
