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
import math
from dataclasses import fields, replace
from pathlib import Path

import h5py
import numpy as np

import closed_form
import instruments
import rig
from instruments import Channel, Motion
from kinds import KINDS

STEPS_IN_A_PERIOD = 256
MOST_PERIODS_N = 6


def draw(seed, kind):
    """The rig and the instruments of a seed, whatever the kind makes of them; all numbers are drawn in one order."""
    rng = np.random.default_rng([seed, 1])
    low, high = kind.restitution
    d = {
        "R": low + (high - low) * rng.random(),
        "beta": rng.uniform(0.03, 0.09),
        "f0": rng.uniform(11.0, 16.0),
        "xst_m": rng.uniform(0.5e-3, 1.5e-3),
        "m_kg": rng.uniform(1.0, 3.0),
        "fy": 1.0 + rng.uniform(-0.03, 0.03),
        "ky": 1.0 + rng.uniform(-0.02, 0.02),
        "noise": rng.uniform(0.001, 0.002),
        "knock": rng.uniform(0.0, 0.07),
        "gap_error": rng.uniform(0.0, 0.003),
        "pulse_s": rng.uniform(3e-4, 8e-4),
        "high_pass_hz": rng.uniform(0.35, 0.5),
        "gain_x": 1.0 + 0.004 * rng.standard_normal(),
        "gain_y": 1.0 + 0.004 * rng.standard_normal(),
        "smear_x": rng.uniform(0.2, 0.8),
        "smear_y": rng.uniform(0.2, 0.8),
        "sign": 1.0 if rng.random() < 0.5 else -1.0,
        "phases": rng.uniform(0.0, 2.0 * math.pi, 2).tolist(),
        "gaps": rng.standard_normal(16).clip(-2.0, 2.0).tolist(),
    }
    if kind.stiffness_ratio:
        d["ky"] = kind.stiffness_ratio
    if kind.force_ratio:
        d["fy"] = kind.force_ratio
    if kind.mass_ratio != 1.0:
        d["fy"] = d["ky"] = 1.0
    return d


def machine(d, kind):
    """The integrator's parameters of the rig, without setting."""
    p = np.zeros(rig.PARAMETERS)
    omega = 2.0 * math.pi * d["f0"]
    k = d["m_kg"] * omega**2
    p[rig.MX], p[rig.KX], p[rig.BX] = d["m_kg"], k, 2.0 * d["beta"] * d["m_kg"] * omega
    p[rig.FX] = k * d["xst_m"]
    if kind.machine == "double":
        p[rig.MY], p[rig.KY] = kind.mass_ratio * p[rig.MX], d["ky"] * p[rig.KX]
        p[rig.BY], p[rig.FY] = p[rig.BX], d["fy"] * p[rig.FX]
        p[rig.IY] = 1.0 / p[rig.MY]
    p[rig.IX] = 1.0 / p[rig.MX]
    if kind.second_mode:
        m2 = kind.second_mode * d["m_kg"]
        p[rig.MODE_M] = m2
        p[rig.MODE_K] = m2 * (kind.second_mode_ratio * omega) ** 2
        p[rig.MODE_B] = 2.0 * 0.02 * m2 * kind.second_mode_ratio * omega
    p[rig.RESTITUTION] = d["R"]
    speed = d["xst_m"] * omega
    p[rig.SPEED_EXPONENT], p[rig.SPEED_REFERENCE] = kind.speed_exponent, 4.0 * speed
    p[rig.CORNER_X] = p[rig.CORNER_Y] = 2.0 * math.pi * d["high_pass_hz"]
    p[rig.STICK_SPEED] = 1e-8 * speed
    p[rig.STEP] = 1.0 / (STEPS_IN_A_PERIOD * d["f0"])
    if kind.second_mode:
        p[rig.STEP] /= kind.second_mode_ratio / 4.0
    if kind.contact != "rigid":
        p[rig.LAW] = rig.SPRING_DAMPER if kind.contact == "spring-damper" else rig.HUNT_CROSSLEY
        reduced = 1.0 / (p[rig.IX] + p[rig.IY])
        law = rig.contact_for(p[rig.LAW], d["R"], kind.contact_s, reduced, 2.0 * speed)
        p[rig.CONTACT_K], p[rig.CONTACT_C] = law
        p[rig.TOUCH_SPEED] = 2.0 * speed
        p[rig.CONTACT_STEP] = kind.contact_s / 60.0
    if kind.effects:
        add_effects(p, d, kind.effects)
    return p


def add_effects(p, d, strength):
    """Springs that harden, friction and a distorted drive, in multiples of what a good rig has."""
    largest = 3.0 * d["xst_m"]
    p[rig.HARDENING] = 0.004 * strength / largest**2
    p[rig.FRICTION] = 0.005 * strength * p[rig.FX]
    p[rig.SPEED_OF_FRICTION] = 1e-3 * d["xst_m"] * 2.0 * math.pi * d["f0"]
    p[rig.A2], p[rig.A3] = 0.005 * strength, 0.003 * strength
    p[rig.PHI2], p[rig.PHI3] = d["phases"]


def sweeps(d, kind):
    """Sweeps of one clearance and direction each: (index of the clearance, r/x_st, direction, [(frequency, recorded)])."""
    if kind.boundary_step:
        return boundary_sweeps(d, kind)
    etas = np.linspace(kind.lowest, kind.highest, kind.frequencies)
    up = [(eta * d["f0"], True) for eta in etas]
    return [
        (index, rho, direction, up if direction == "up" else up[::-1])
        for index, rho in enumerate(kind.clearances)
        for direction in ("up", "down")
    ]


def boundary_sweeps(d, kind):
    """Sweeps in fine steps across the end of z = 1 (up) and across grazing (down), approached without recording."""
    rng = np.random.default_rng([d["seed"], 4])
    beta, restitution, step = d["beta"], d["R"], kind.boundary_step
    result = []
    for index, end in enumerate((1.15, 1.3, 1.45, 1.6)):
        rho = closed_form.saddle_node(end, beta, restitution)
        grazing = closed_form.crossing(lambda eta: closed_form.amplitude(eta, beta), rho, 1.0, 2.5)
        for direction, at, start, sign in (("up", end, 1.0, 1.0), ("down", grazing, end + 0.25, -1.0)):
            recorded = at + sign * step * (np.arange(-3, 3) + rng.random())
            lead = np.arange(start, recorded[0], sign * 0.02)
            chain = [(eta * d["f0"], False) for eta in lead] + [(eta * d["f0"], True) for eta in recorded]
            result.append((index, rho, direction, chain))
    return result


def channels(d, kind):
    """The channels with their errors."""
    speed = d["xst_m"] * 2.0 * math.pi * d["f0"]
    late = dict(kind.late_s)
    result = []
    for role in kind.roles:
        name = {"drive": "generator", "contact": "contact"}.get(role, f"sensor_{role}")
        noise = 10.0 * d["noise"] * (1.0 if kind.bits == 12 else 0.1)
        c = Channel(role, name, delay_s=late.get(role, 0.0), noise_v=noise, bits=kind.bits)
        if role not in ("drive", "contact"):
            c = motion_channel(c, d, kind, speed)
        result.append(c)
    return result


def motion_channel(c, d, kind, speed):
    """Scale, gain and filters of a channel of motion."""
    of_x = c.role.endswith("x")
    gain = d["gain_x"] if of_x else d["gain_y"]
    if of_x and kind.gain_x != 1.0:
        gain = kind.gain_x
    if c.role.startswith("velocity"):
        scale, unit = 0.1, "m/s/V"
    elif c.role.startswith("displacement"):
        scale, unit = 1e-3, "m/V"
    else:
        spike = 2.0 * 3.5 * speed * kind.rate_hz
        scale = float(f"{(spike if kind.spikes_fit else 0.1 * spike) / 10.0:.2g}")
        unit = "m/s^2/V"
    c = replace(c, scale=scale, scale_text=f"{scale:g} {unit}", gain=gain)
    c = replace(c, high_passed=c.role == "velocity_y", low_pass=kind.low_pass)
    if kind.smear:
        c = replace(c, smear=d["smear_x"] if of_x else d["smear_y"])
    if of_x:
        c = replace(c, pickup_drive=kind.pickup_drive, pickup_contact=kind.pickup_contact)
    return c


class Bench:
    """The rig on which one record after the other is taken; its motion is carried on from record to record."""

    def __init__(self, d, kind):
        self.d, self.kind = d, kind
        self.rng = np.random.default_rng([d["seed"], 2])
        self.state = np.zeros(rig.STATES)
        self.stuck = False
        self.phase = self.rng.uniform(0.0, 2.0 * math.pi)
        self.p = machine(d, kind)
        self.force = self.p[[rig.FX, rig.FY]].copy()

    def other_rig(self):
        """From here on another rig."""
        d = {**self.d, "R": self.d["R"] + self.kind.other_restitution}
        d["f0"] *= 1.0 + self.kind.other_frequency
        self.p = machine(d, self.kind)
        # Another stiffness with the same masses: the same static deflection.
        self.force = self.p[[rig.FX, rig.FY]].copy()

    def start_sweep(self):
        """At rest, as after the gap was set."""
        self.state[:] = 0.0
        self.stuck = False

    def set(self, frequency_hz, gap_m):
        """Frequency and gap; the generator's phase goes on."""
        self.p[rig.OMEGA], self.p[rig.PHASE] = 2.0 * math.pi * frequency_hz, self.phase
        self.p[rig.GAP] = gap_m
        slope = 1.0 + 0.01 * self.kind.effects * self.d["sign"] * (frequency_hz / self.d["f0"] - 1.0)
        self.p[[rig.FX, rig.FY]] = self.force * slope

    def knock(self):
        """What slamming doors and adjusting the generator do to the masses."""
        size = self.d["knock"] * self.d["xst_m"] * 2.0 * math.pi * self.d["f0"]
        kick = size * self.rng.standard_normal(2)
        self.state[1] += kick[0]
        if self.kind.machine == "double":
            self.state[3] += kick[1]
        self.stuck = False

    def run(self, begin, end, times):
        """States at the times, and the impacts; the rig's own state moves on."""
        states = np.empty((len(times), rig.STATES))
        room = 2000 + int(400 * (end - begin))
        while True:
            state, impacts = self.state.copy(), np.empty((room, 6))
            stuck, n = rig.move(state, begin, end, self.p, self.stuck, times, states, impacts)
            if n >= 0:
                self.state, self.stuck = state, stuck
                return states, impacts[:n]
            room *= 4

    def record(self, sensors, ticks):
        """Motion during one record whose first sample is at ticks[0], after settling from time 0 on."""
        needed = [instruments.times_needed(c, ticks) for c in sensors]
        omega = self.p[rig.OMEGA]
        strobes = ticks[0] + 0.123 * 2.0 * math.pi / omega
        strobes = np.arange(strobes, ticks[-1], 2.0 * math.pi / omega)
        times = np.unique(np.concatenate([*needed, strobes]))
        if times[0] < 0.0:
            raise ValueError("the channels need the motion before the rig was set")
        end = max(ticks[-1], times[-1]) + 1e-9
        states, impacts = self.run(0.0, end, times)
        motion = Motion(times, states, impacts, self.d["pulse_s"], omega, self.phase)
        self.phase = math.fmod(self.phase + omega * end, 2.0 * math.pi)
        self.p[rig.PHASE] = self.phase
        return motion, strobes

    def label(self, motion, strobes):
        """(p, n) of the motion and whether the record shows it from its beginning on; None: no period."""
        found = self.period(motion.at(strobes), strobes, motion.impacts)
        if found:
            return found, True
        kept = self.state.copy(), self.stuck
        period = 2.0 * math.pi / self.p[rig.OMEGA]
        strobes = period * (300.123 + np.arange(25))
        states, impacts = self.run(0.0, strobes[-1] + 1e-9, strobes)
        self.state, self.stuck = kept
        return self.period(states, strobes, impacts), False

    def period(self, states, strobes, impacts):
        """(p, n) if the states at the strobes repeat, else None."""
        d = self.d
        size = np.array([d["xst_m"], d["xst_m"] * 2.0 * math.pi * d["f0"]] * 2)
        scaled = states[:, :4] / size
        for n in range(1, min(MOST_PERIODS_N, (len(strobes) - 1) // 2) + 1):
            if np.abs(scaled[n:] - scaled[:-n]).max() < 2e-3:
                whole = (len(strobes) - 1) // n * n
                inside = (impacts[:, 0] > strobes[0]) & (impacts[:, 0] <= strobes[whole])
                count = inside.sum() * n / whole
                return (int(round(count)), n) if abs(count - round(count)) < 1e-9 else None
        return None


def measure(d, kind):
    """All records: (setting, counts, size of a count, label, settled, impacts with their speeds, masses that stuck)."""
    bench, sensors = Bench(d, kind), channels(d, kind)
    noise = np.random.default_rng([d["seed"], 3])
    plan = sweeps(d, kind)
    half = sum(recorded for *_, chain in plan for _, recorded in chain) // 2
    changes = kind.other_restitution or kind.other_frequency
    period = (1.0 + kind.clock) / kind.rate_hz
    number = 0
    for index, rho, direction, chain in plan:
        bench.start_sweep()
        stated_m = rho * d["xst_m"]
        clearance = stated_m * (1.0 + d["gap_error"] * d["gaps"][index] / 2.0) + (kind.gap_off_m if index == 1 else 0.0)
        gap = clearance * (2.0 if kind.machine == "double" else 1.0)
        for frequency, recorded in chain:
            if changes and number == half:
                bench.other_rig()
            bench.set(frequency, gap)
            if not recorded:
                _, _ = bench.run(0.0, 3.0, np.empty(0))
                bench.phase = math.fmod(bench.phase + bench.p[rig.OMEGA] * 3.0, 2.0 * math.pi)
                continue
            bench.knock()
            lead = 3.0 * max([period, *(late for _, late in kind.late_s)])
            ticks = max(kind.settle_s, lead) + period * np.arange(round(kind.duration_s * kind.rate_hz))
            motion, strobes = bench.record(sensors, ticks)
            label, settled = bench.label(motion, strobes)
            hits = motion.impacts[motion.impacts[:, 0] >= ticks[0]]
            columns = [instruments.converted(c, instruments.samples(c, motion, ticks), noise) for c in sensors]
            setting = {"clearance_mm": 1e3 * stated_m, "sweep": direction}
            if kind.frequency_stated:
                setting["frequency_hz"] = frequency
            yield setting, columns, label, settled, hits, bench.stuck
            number += 1


def selected(records, kind, d):
    """The records that the kind keeps."""
    records = list(records)
    if kind.select == "z0":
        return [r for r in records if len(r[4]) == 0 and r[3]]
    if kind.select == "few":
        rng = np.random.default_rng([d["seed"], 5])
        impacting = [i for i, r in enumerate(records) if r[2] == (1, 1) and r[3]]
        free = [i for i, r in enumerate(records) if r[2] == (0, 1) and r[3]]
        kept = {*rng.permutation(impacting)[:2].tolist(), *rng.permutation(free)[:6].tolist()}
        return [r for i, r in enumerate(records) if i in kept]
    return records


def truth(d, kind, impacts):
    """What the campaign should find: frequencies and damping from eigenvalues, by definition of the README."""
    p = machine(d, kind)
    mode = (p[rig.MODE_M], p[rig.MODE_K], p[rig.MODE_B]) if kind.second_mode else None
    own = [rig.natural(p[rig.MX], p[rig.KX], p[rig.BX], mode)]
    deflections = [p[rig.FX] / p[rig.KX]]
    if kind.machine == "double":
        own.append(rig.natural(p[rig.MY], p[rig.KY], p[rig.BY], mode))
        deflections.append(p[rig.FY] / p[rig.KY])
    restitution = d["R"]
    if kind.speed_exponent and len(impacts):
        restitution = float(np.median(impacts[:, 3] / impacts[:, 1]))
    return {
        "restitution": restitution,
        "natural_frequency_hz": math.exp(np.mean([math.log(f) for f, _ in own])),
        "damping_ratio": float(np.mean([b for _, b in own])),
        "static_deflection_m": float(np.mean(deflections)),
    }


def alternatives(d, kind, main):
    """Other values that an interval may hold: of the second half's rig, of R of the whole body."""
    if kind.other_restitution or kind.other_frequency:
        other = {**d, "R": d["R"] + kind.other_restitution, "f0": d["f0"] * (1.0 + kind.other_frequency)}
        return truth(other, kind, ())
    if kind.second_mode:
        mu = kind.second_mode
        return {**main, "restitution": (d["R"] - mu) / (1.0 + mu)}
    return None


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
        if c.high_passed:
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
    parser.add_argument("kind", nargs="?", choices=sorted(KINDS), metavar="KIND")
    parser.add_argument("seed", nargs="?", type=int)
    parser.add_argument("folder", nargs="?")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a field of kinds.Kind")
    parser.add_argument("--list", action="store_true", help="the kinds")
    parser.add_argument("--selftest", action="store_true", help="the simulator against closed forms")
    given = parser.parse_args()
    if given.list:
        for name, kind in KINDS.items():
            print(f"{name:24} {kind.about}")
    elif given.selftest:
        import selftest

        selftest.run()
    elif given.folder is None:
        parser.error("KIND, SEED and FOLDER are needed")
    else:
        make(given.kind, with_settings(KINDS[given.kind], given.set), given.seed, given.folder)


if __name__ == "__main__":
    main()
