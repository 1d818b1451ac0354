#!/usr/bin/env python3
"""A simulated laboratory that shares nothing with impactid: a campaign with its truth, from a kind and a seed.

    python laboratory.py KIND SEED FOLDER [--set KEY=VALUE ...]
    python laboratory.py --list
    python laboratory.py --selftest

Needs Python 3.11 with numpy, numba and h5py. The same kind and seed give the same campaign; the same seed gives
every kind the same rig. FOLDER receives campaign.h5, campaign.toml, truth.json and truth_motions.csv.
"""

import argparse
import ast
import csv
import json
from dataclasses import fields, replace
from pathlib import Path

import h5py
import numpy as np

from bench import measure, selected
from drawn import flawed_laboratory_of, laboratory_of
from instruments import channels
from kinds import KINDS
from specimen import alternatives, draw, truth


DRAWN = {
    "any": (laboratory_of, "rig, instruments and settings drawn from the seed"),
    "flawed": (flawed_laboratory_of, "the same with one flaw"),
}


def campaign_toml(d, kind, name, sensors):
    """campaign.toml as this laboratory writes it."""
    lines = ["[campaign]", f'name = "{name}"', f'machine = "{kind.machine}"', "[records]", 'files = "campaign.h5"']
    lines += ["[records.attributes]", 'clearance = "clearance_mm"', 'sweep = "sweep"']
    if kind.frequency_stated:
        lines.append('drive_frequency = "frequency_hz"')
    for c in sensors:
        lines += [f"[channels.{c.role}]", f'channel = "{c.name}"', 'unit = "V"']
        if c.role == "contact":
            lines.append('threshold = "2.4 V"')
        if c.scale_text:
            lines.append(f'scale = "{c.scale_text}"')
        if c.high_passed and not kind.high_pass_hidden:
            lines.append(f'high_pass = "{d["high_pass_hz"]:.3f} Hz"')
        if kind.low_pass_stated and c.low_pass[0]:
            lines.append(f'low_pass = "{c.low_pass[1]:g} Hz"')
            lines.append(f"low_pass_order = {c.low_pass[0]}")
    lines += ["[rig]", 'gain_uncertainty = "0.5 %"']
    if kind.masses_stated:
        lines += [f'mass_x = "{d["m_kg"]:.3f} kg"', f'mass_y = "{kind.mass_ratio * d["m_kg"]:.3f} kg"']
    return "\n".join(lines) + "\n"


def make(name, kind, seed, folder):
    """Writes the campaign of a kind and a seed."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    d = {**draw(seed, kind), "seed": seed}
    sensors = channels(d, kind)
    records = selected(measure(d, kind), kind, d)
    with h5py.File(folder / "campaign.h5", "w") as file:
        for i, (setting, columns, *_) in enumerate(records):
            table = np.column_stack([counts for counts, _ in columns])
            data = file.create_dataset(f"record_{i:04d}/signals", data=table)
            data.attrs["channels"] = [c.name for c in sensors]
            data.attrs["scale"] = [size for _, size in columns]
            data.attrs["sample_rate_hz"] = kind.rate_hz
            for key, value in setting.items():
                data.attrs[key] = value
    (folder / "campaign.toml").write_text(campaign_toml(d, kind, name, sensors))
    impacts = np.concatenate([r[4] for r in records] or [np.empty((0, 6))])
    main = truth(d, kind, impacts)
    answer = {**d, "kind": name, "truth": main, "alternative": alternatives(d, kind, main)}
    (folder / "truth.json").write_text(json.dumps(answer, indent=1))
    with open(folder / "truth_motions.csv", "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["record", "impacts_p", "periods_n", "settled", "stuck", "impacts"])
        for i, (_, _, label, settled, hits, stuck) in enumerate(records):
            p, n = label or ("", "")
            rows.writerow([f"record_{i:04d}", p, n, int(settled), int(stuck), len(hits)])


def kind_of(name, seed):
    """The kind of a name; of one that is drawn that of the seed."""
    return DRAWN[name][0](seed) if name in DRAWN else KINDS[name]


def with_settings(kind, settings):
    """The kind with KEY=VALUE settings, values as Python literals."""
    known = {f.name for f in fields(kind)}
    for setting in settings:
        key, _, value = setting.partition("=")
        if key not in known:
            raise SystemExit(f"no setting {key!r}; there are {', '.join(sorted(known))}")
        try:
            kind = replace(kind, **{key: ast.literal_eval(value)})
        except (ValueError, SyntaxError):
            kind = replace(kind, **{key: value})
    return kind


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", nargs="?", choices=sorted([*KINDS, *DRAWN]), metavar="KIND")
    parser.add_argument("seed", nargs="?", type=int)
    parser.add_argument("folder", nargs="?")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a field of kinds.Kind")
    parser.add_argument("--list", action="store_true", help="the kinds")
    parser.add_argument("--selftest", action="store_true", help="the simulator against closed forms")
    given = parser.parse_args()
    if given.list:
        for name, kind in KINDS.items():
            print(f"{name:24} {kind.about}")
        for name, (_, about) in DRAWN.items():
            print(f"{name:24} {about}")
    elif given.selftest:
        import selftest

        selftest.run()
    elif given.folder is None:
        parser.error("KIND, SEED and FOLDER are needed")
    else:
        make(given.kind, with_settings(kind_of(given.kind, given.seed), given.set), given.seed, given.folder)


if __name__ == "__main__":
    main()
