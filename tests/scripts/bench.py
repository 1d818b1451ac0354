"""Taking the records: sweeps of frequency, settling, knocks; the motion is carried on from record to record."""

import math

import numpy as np

import closed_form
import instruments
import rig
from instruments import Motion
from specimen import machine, natural

MOST_PERIODS_N = 6


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


class Bench:
    """The rig on which one record after the other is taken; its motion is carried on from record to record."""

    def __init__(self, d, kind):
        self.d, self.kind = d, kind
        self.rng = np.random.default_rng([d["seed"], 2])
        self.state = np.zeros(rig.STATES)
        self.stuck = False
        self.phase = self.rng.uniform(0.0, 2.0 * math.pi)
        self.p = machine(d, kind)
        self.natural_hz, _ = natural(self.p, kind)
        self.other = False
        self.force = self.p[[rig.FX, rig.FY]].copy()

    def take_rig(self, other):
        """From here on the rig itself, or the other one."""
        if other == self.other:
            return
        self.other = other
        d = dict(self.d)
        if other:
            d["R"] += self.kind.other_restitution
            d["f0"] *= 1.0 + self.kind.other_frequency
            d["beta"] *= 1.0 + self.kind.other_damping
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
        self.p[[rig.FX, rig.FY]] = self.force * slope * (frequency_hz / self.natural_hz) ** self.kind.force_power

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
        """(p, n) of the motion that the rig settles to and whether the record shows it from its beginning on; None:
        no period. What closes after several periods alone may be a disturbance that dies slowly."""
        found = self.period(motion.at(strobes), strobes, motion.impacts)
        if found and found[1] == 1:
            return found, True
        kept = self.state.copy(), self.stuck
        period = 2.0 * math.pi / self.p[rig.OMEGA]
        strobes = period * (300.123 + np.arange(25))
        states, impacts = self.run(0.0, strobes[-1] + 1e-9, strobes)
        self.state, self.stuck = kept
        last = self.period(states, strobes, impacts)
        return last, found is not None and found == last

    def period(self, states, strobes, impacts):
        """(p, n) if the states at the strobes repeat, else None."""
        d = self.d
        size = np.array([d["xst_m"], d["xst_m"] * 2.0 * math.pi * d["f0"]] * 2)
        scaled = states[:, :4] / size
        for n in range(1, min(MOST_PERIODS_N, (len(strobes) - 1) // 2) + 1):
            if np.abs(scaled[n:] - scaled[:-n]).max() < 2e-3 + 6.0 * self.kind.scatter:
                whole = (len(strobes) - 1) // n * n
                inside = (impacts[:, 0] > strobes[0]) & (impacts[:, 0] <= strobes[whole])
                count = inside.sum() * n / whole
                return (int(round(count)), n) if abs(count - round(count)) < 1e-9 else None
        return None


def is_other(kind, later, index, direction):
    """Whether a record is taken on the other rig, of a campaign of two."""
    return {"half": later, "gap": index == 1, "sweep": direction == "down"}[kind.other_of]


def measure(d, kind):
    """All records: (setting, counts, size of a count, label, settled, impacts with their speeds, masses that stuck)."""
    bench, sensors = Bench(d, kind), instruments.channels(d, kind)
    noise = np.random.default_rng([d["seed"], 3])
    plan = sweeps(d, kind)
    half = sum(recorded for *_, chain in plan for _, recorded in chain) // 2
    changes = kind.other_restitution or kind.other_frequency or kind.other_damping
    period = (1.0 + kind.clock) / kind.rate_hz
    number = 0
    for index, rho, direction, chain in plan:
        bench.start_sweep()
        stated_m = rho * d["xst_m"]
        clearance = stated_m * (1.0 + d["gap_error"] * d["gaps"][index] / 2.0) + (kind.gap_off_m if index == 1 else 0.0)
        gap = clearance * (2.0 if kind.machine == "double" else 1.0)
        for frequency, recorded in chain:
            bench.take_rig(changes and is_other(kind, number >= half, index, direction))
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
            part = number / (kind.frequencies * 2 * len(kind.clearances) - 1)
            grown = 1.0 + kind.gain_drift * part + kind.gain_step * (number >= half)
            volts = [instruments.samples(c, motion, ticks) * (grown if c.role.endswith("x") else 1.0) for c in sensors]
            columns = [instruments.converted(c, v, period, noise) for c, v in zip(sensors, volts)]
            if kind.frozen:
                instruments.freeze([counts for counts, _ in columns], kind, noise)
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
