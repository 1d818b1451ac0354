"""How often the 95 % intervals of f0 and β of free decays hold the truth.

Decays are drawn at random: frequency, damping ratio, phase, offset, rate, and how many periods the record holds; beside
each lies noise of one kind, and dry friction may take a part of the first cycle's loss. `loud_hum` is a hum of 5 to 60 % of
the first amplitude; `blow` and `stop` are white noise about a motion that a blow begins again before it is over, and that a
hand ends within a period; `held` is white noise about a mass that is held up to six periods before it is released; `drift`
is white noise and a line over the record of up to the first amplitude; `slow_stop` is a hand that takes one period to half of
them, and `rub` is dry friction that begins on the way and lasts. Each record is a specimen of its
own, so that `impactid` states f0 and β of each with an interval; one that is left open, or not found, counts for nothing.

    python3 decay_coverage.py --binary target/release/impactid --work FOLDER [--seed 1] [--records 200] [--kinds white,slow]
        [--friction 0.2] [--without-friction]

Prints for each kind of noise and each range of periods how many decays were found, the shares that the intervals of f0
and β hold, and their median half widths.
"""

import argparse
import json
import pathlib
import subprocess

import numpy

KINDS = ["white", "coloured", "slow", "quantised", "hum", "loud_hum", "blow", "stop", "held", "drift", "slow_stop", "rub"]
PERIODS = {"1.5-2": (1.5, 2.0), "2-5": (2.0, 5.0), "5-20": (5.0, 20.0), "20-200": (20.0, 200.0)}


def autoregressive(rng, count, correlation):
    """Stationary noise of the first order, of unit variance."""
    shocks = rng.standard_normal(count) * numpy.sqrt(1 - correlation**2)
    out = numpy.empty(count)
    out[0] = rng.standard_normal()
    for i in range(1, count):
        out[i] = correlation * out[i - 1] + shocks[i]
    return out


def rubbed(natural, damping, friction, amplitude, times):
    """A viscous oscillator with dry friction: x'' + 2βωx' + ω²x + ω²μ sign(x') = 0, half swing by half swing."""
    sigma, omega = damping * natural, natural * numpy.sqrt(1 - damping**2)
    out = numpy.zeros(len(times))
    begin, place, side = 0.0, amplitude, 1.0
    while begin < times[-1]:
        # from a turning point on, about the equilibrium shifted by the friction
        about = side * friction
        if abs(place) <= friction:
            out[times >= begin] = place
            break
        half = numpy.pi / omega
        own = (times >= begin) & (times < begin + half)
        t = times[own] - begin
        out[own] = about + (place - about) * numpy.exp(-sigma * t) * (
            numpy.cos(omega * t) + sigma / omega * numpy.sin(omega * t)
        )
        place = about - (place - about) * numpy.exp(-sigma * half)
        begin, side = begin + half, -side
    return out


def decay(rng, kind, periods, friction):
    """Samples of one decay, m, with its truth."""
    f0 = float(10 ** rng.uniform(-0.5, 2.3))
    damping = float(10 ** rng.uniform(-2.7, numpy.log10(0.5))) if periods[1] <= 5 else float(10 ** rng.uniform(-3.3, -1.2))
    natural = 2 * numpy.pi * f0
    omega = natural * numpy.sqrt(1 - damping**2)
    turns = rng.uniform(*periods)
    per_period = rng.uniform(25, 120)
    if turns > 60:
        per_period = rng.uniform(12, 30)
    rate = per_period * omega / (2 * numpy.pi)
    times = numpy.arange(int(turns * per_period)) / rate
    amplitude, phase = 10 ** rng.uniform(-4, -2), rng.uniform(0, numpy.pi)
    noise = amplitude * 10 ** rng.uniform(-3.5, -1.5)
    # 4 r of 4 r + 2πβA in the first cycle
    rest = 0.5 * numpy.pi * damping * amplitude * friction / (1 - friction)
    values = rubbed(natural, damping, rest, amplitude, times + phase / omega)
    count = len(times)
    if kind == "blow":
        since = times - times[-1] * rng.uniform(0.3, 0.6)
        again = numpy.exp(-damping * natural * since) * numpy.sin(omega * since)
        values += numpy.where(since > 0, rng.uniform(0.3, 1.5) * amplitude * again, 0.0)
    elif kind == "held":
        held = rng.uniform(0.2, 6.0) / f0
        before = numpy.arange(round(held * rate))
        values = numpy.concatenate([numpy.full(len(before), amplitude), rubbed(natural, damping, rest, amplitude, times)])
        times = numpy.arange(len(values)) / rate
        count = len(times)
    elif kind == "stop":
        since = times - times[-1] * rng.uniform(0.4, 0.8)
        takes = rng.uniform(0.05, 1.0) / f0
        values *= numpy.clip(1.0 - since / takes, 0.0, 1.0)
    elif kind == "slow_stop":
        since = times - times[-1] * rng.uniform(0.3, 0.9)
        takes = rng.uniform(min(1.0, 0.25 * turns), 0.5 * turns) / f0
        values *= numpy.clip(1.0 - since / takes, 0.0, 1.0)
    elif kind == "rub":
        # from a turning point on, at which it takes 2 to 50 % of the amplitude in each half swing
        swings = max(1, int(2 * turns * rng.uniform(0.3, 0.9)))
        begins = swings * numpy.pi / omega - phase / omega
        there = amplitude * numpy.exp(-damping * natural * swings * numpy.pi / omega)
        after = times >= begins
        rubs = 0.5 * there * 10 ** rng.uniform(-1.7, -0.3)
        values[after] = (-1) ** swings * rubbed(natural, damping, rubs, there, times[after] - begins)
    if kind == "drift":
        values += amplitude * rng.uniform(-1.0, 1.0) * times / times[-1]
    if kind in ("white", "blow", "stop", "held", "drift", "slow_stop", "rub"):
        values += noise * rng.standard_normal(count)
    elif kind == "coloured":
        values += noise * autoregressive(rng, count, rng.uniform(0.3, 0.9))
    elif kind == "slow":
        # correlated over a good part of a period and up to several
        correlation = numpy.exp(-1.0 / (per_period * 10 ** rng.uniform(-1, 0.7)))
        values += noise * autoregressive(rng, count, correlation)
    elif kind == "loud_hum":
        hum = f0 * (rng.uniform(0.3, 0.75) if rng.random() < 0.5 else rng.uniform(1.3, 7.0))
        values += noise * rng.standard_normal(count)
        values += amplitude * 10 ** rng.uniform(-1.3, -0.2) * numpy.cos(2 * numpy.pi * hum * times + rng.uniform(0, 6.28))
    elif kind == "hum":
        hum = rng.choice([3.2, 5.0, 7.7]) * f0
        values += noise * rng.standard_normal(count)
        values += 10 * noise * numpy.cos(2 * numpy.pi * hum * times + rng.uniform(0, 6.28))
    values += amplitude * rng.uniform(-0.5, 0.5)
    if kind == "quantised":
        step = amplitude * 10 ** rng.uniform(-3, -1.3)
        values = step * numpy.round((values + 0.2 * step * rng.standard_normal(count)) / step)
    return times, values, {"f0": f0, "beta": damping, "turns": turns}


def written(folder, seed, kind, name, options):
    folder.mkdir(parents=True, exist_ok=True)
    truth, records = {}, options.records
    table = "file,specimen\n" + "".join(f"r{k:03}.csv,r{k:03}\n" for k in range(records))
    (folder / "runs.csv").write_text(table)
    for number in range(records):
        rng = numpy.random.default_rng([seed, KINDS.index(kind), list(PERIODS).index(name), number])
        times, values, truth[f"r{number:03}"] = decay(rng, kind, PERIODS[name], options.friction)
        rows = numpy.column_stack([times, values])
        numpy.savetxt(folder / f"r{number:03}.csv", rows, fmt="%.12g", delimiter=",", header="t (s),x (m)", comments="")
    rig = "[rig]\neffects = []\n" if options.without_friction else ""
    (folder / "campaign.toml").write_text(
        '[campaign]\nmachine = "single"\n[records]\nrun_table = "runs.csv"\nexcitation = "free_decay"\n'
        '[channels.displacement_x]\nchannel = "x"\n' + rig
    )
    return truth


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", required=True)
    parser.add_argument("--work", required=True, type=pathlib.Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--records", type=int, default=200)
    parser.add_argument("--kinds", default=",".join(KINDS))
    parser.add_argument("--periods", default=",".join(PERIODS))
    parser.add_argument("--friction", type=float, default=0.0, help="part of the first cycle's loss")
    parser.add_argument("--without-friction", action="store_true", help="state that the rig has none")
    options = parser.parse_args()
    print("noise periods found f0 beta half_f0 half_beta")
    for kind in options.kinds.split(","):
        for name in options.periods.split(","):
            folder = options.work / f"{kind}-{name}-{options.friction}-{options.seed}"
            truth = written(folder, options.seed, kind, name, options)
            out = folder / "out"
            command = [options.binary, "run", "campaign.toml", "--out", "out", "--format", "csv"]
            subprocess.run(command, cwd=folder, capture_output=True, check=False)
            found = json.loads((out / "identification.json").read_text())["specimens"]
            rows = []
            for record, true in truth.items():
                joint = found.get(record, {}).get("joint", {})
                estimates = [joint.get(n, {}).get("interval95") for n in ("natural_frequency_hz", "damping_ratio")]
                if None in estimates:
                    continue
                (low, high), (least, most) = estimates
                middles = (0.5 * (low + high) / true["f0"] - 1, 0.5 * (least + most) - true["beta"])
                rows.append((middles[0], 0.5 * (high - low) / true["f0"], middles[1], 0.5 * (most - least)))
            a = numpy.array(rows)
            held = [100 * numpy.mean(numpy.abs(a[:, k]) <= a[:, k + 1]) for k in (0, 2)]
            half = [numpy.median(a[:, 1]), numpy.median(a[:, 3])]
            print(f"{kind} {name} {len(a)}/{options.records} {held[0]:.1f} {held[1]:.1f} {half[0]:.2g} {half[1]:.2g}", flush=True)


if __name__ == "__main__":
    main()
