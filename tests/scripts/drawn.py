"""A laboratory of which everything is drawn from the seed: rig, instruments, settings. `any` has sound instruments alone, so that
every parameter that is given should be held; `flawed` has one flaw beside, which should be named or be in the intervals."""

import math
from dataclasses import replace

import numpy as np

from kinds import ACCELERATIONS, BOTH, DISPLACEMENTS, Kind

CONTACT = ("drive", "contact")
OF_TWO = (BOTH, BOTH, BOTH[:1] + BOTH[2:], DISPLACEMENTS, ("drive", "contact", *DISPLACEMENTS[1:]),
          ACCELERATIONS, ("drive", "contact", *ACCELERATIONS[1:]), BOTH[:3], ("drive", "contact", "displacement_x"))
OF_ONE = (("drive", "contact", "velocity_x"), ("drive", "velocity_x"), ("drive", "contact", "displacement_x"),
          ("drive", "contact", "velocity_x", "displacement_x"), ("drive", "acceleration_x"))


def laboratory_of(seed):
    """The laboratory of a seed."""
    rng = np.random.default_rng([seed, 6])

    def log_uniform(low, high):
        return float(math.exp(rng.uniform(math.log(low), math.log(high))))

    def sometimes(share, value, otherwise):
        return value if rng.random() < share else otherwise

    frequency_hz, damping = log_uniform(4.0, 40.0), log_uniform(0.01, 0.12)
    speed = log_uniform(0.04, 0.15)
    deflection_m = min(2e-3, speed / (2.0 * math.pi * frequency_hz))
    machine = sometimes(0.75, "double", "single")
    choice = OF_TWO if machine == "double" else OF_ONE
    roles = choice[int(rng.integers(len(choice)))]
    accelerations = any(role.startswith("acceleration") for role in roles)
    rate_hz = float(round(log_uniform(max(500.0, 50.0 * frequency_hz), 2e4), -1))
    gaps = np.sort(rng.uniform(0.3, 2.5, int(rng.integers(2, 6))))
    gaps = tuple(round(float(g), 3) for g in gaps[np.diff(gaps, prepend=0.0) > 0.1])
    folds = rng.uniform(8.0, 40.0)  # time constants of the free oscillation before a record
    restitution = float(rng.uniform(0.1, 0.93))
    # a spring and damper that only press cannot restore less
    contact = sometimes(0.25 if restitution > 0.2 else 0.0, "spring-damper", "rigid")
    return Kind(
        "everything drawn",
        rate_hz=rate_hz,
        duration_s=float(round(rng.uniform(8.0, 40.0) / frequency_hz, 3)),
        settle_s=folds / (2.0 * math.pi * damping * frequency_hz),
        roles=roles,
        bits=16 if accelerations else int(rng.choice((12, 14, 16))),
        frequency_stated=sometimes(0.8, True, False),
        clearances=gaps,
        lowest=float(rng.uniform(0.7, 0.9)),
        highest=float(rng.uniform(1.6, 2.4)),
        frequencies=int(rng.integers(5, 21)),
        machine=machine,
        restitution=(restitution, restitution),
        frequency_hz=(frequency_hz, frequency_hz),
        damping=(damping, damping),
        deflection_m=(deflection_m, deflection_m),
        mass_ratio=sometimes(0.2, float(rng.uniform(0.85, 1.15)), 1.0),
        effects=sometimes(0.3, float(rng.uniform(0.0, 1.0)), 0.0),
        force_power=sometimes(0.15, 2.0, 0.0),
        contact=contact,
        contact_s=0.01 / frequency_hz * float(rng.uniform(0.1, 0.5)),
        noise=log_uniform(0.3, 2.0),
    )


def flaws(kind, rng):
    """Flaws that a laboratory of a kind may have, by name: what they change, drawn anew."""
    f0, rate_hz = kind.frequency_hz[0], kind.rate_hz
    x = next(role for role in kind.roles if role.endswith("_x"))
    either = (-1.0, 1.0)[int(rng.integers(2))]
    late_s = float(rng.uniform(3.0, 8.0)) / rate_hz + float(rng.uniform(0.0, 0.02)) / f0
    possible = {
        "gain": {"gain_x": 1.0 + either * float(rng.uniform(0.03, 0.15))},
        "gain_step": {"gain_step": float(rng.uniform(0.02, 0.06))},
        "gain_drift": {"gain_drift": float(rng.uniform(0.02, 0.06))},
        "clock": {"clock": either * float(rng.uniform(5e-4, 2e-3)), "frequency_stated": True},
        "late": {"late_s": ((x, late_s),)},
        "late_drive": {"late_s": (("drive", late_s),)},
        "low_pass": {"low_pass": (int(rng.integers(1, 5)), float(min(rng.uniform(6.0, 30.0) * f0, 0.4 * rate_hz)))},
        "pickup": {"pickup_drive": float(rng.uniform(2e-3, 2e-2))},
        "gap": {"gap_off_m": either * float(rng.uniform(0.03, 0.25)) * kind.deflection_m[0]},
        "half": {"other_restitution": -float(rng.uniform(0.02, 0.05)), "other_frequency": float(rng.uniform(0.005, 0.02))},
        "half_damping": {"other_damping": either * float(rng.uniform(0.1, 0.3))},
        "slow_noise": {"slow_noise": float(rng.uniform(1.0, 10.0))},
        "hum": {"hum": float(rng.uniform(1.0, 10.0))},
        "outliers": {"outliers": 10.0 ** float(rng.uniform(-4.0, -2.5))},
        "speed": {"speed_exponent": float(rng.uniform(0.05, 0.3))},
        "scatter": {"scatter": float(rng.uniform(0.005, 0.02))},
        "mode": {"second_mode": float(rng.uniform(0.003, 0.01))},
        "unsettled": {"settle_s": 0.0},
        "frozen": {"frozen": 0.25},
        "noise": {"noise": float(rng.uniform(4.0, 10.0))},
        "bits": {"bits": 8},
    }
    if len(kind.roles) > 2 and kind.roles[1] == "contact":
        possible["contact_missed"] = {"contact_missed": float(rng.uniform(0.02, 0.2))}
        possible["chatter"] = {"chatter": True}
        possible["late_contact"] = {"late_s": (("contact", late_s),)}
    if not any(role.startswith("displacement") for role in kind.roles):
        possible["high_pass"] = {"high_pass_hidden": True}
    if x.startswith("acceleration"):
        possible["clipped"] = {"spikes_fit": False}
    if kind.machine == "double":
        possible["force_lag"] = {"force_lag_rad": float(rng.uniform(0.02, 0.1))}
        possible["damping_y"] = {"damping_ratio_y": float(rng.uniform(1.3, 2.0))}
        possible["force_y"] = {"force_ratio": float(rng.uniform(0.0, 0.5)) + 1e-9}
        other = x[:-1] + "y"
        if other in kind.roles:
            possible["crosstalk"] = {"crosstalk": either * float(rng.uniform(0.005, 0.05))}
            possible["late_both"] = {"late_s": ((x, late_s), (other, late_s))}
    return possible


def flawed_laboratory_of(seed):
    """The laboratory of a seed, with one flaw."""
    kind = laboratory_of(seed)
    rng = np.random.default_rng([seed, 7])
    possible = flaws(kind, rng)
    name = list(possible)[int(rng.integers(len(possible)))]
    return replace(kind, about=name, **possible[name])
