"""The rig of a seed: what is drawn, the integrator's parameters, and the truth that a campaign should find."""

import math

import numpy as np

import rig

STEPS_IN_A_PERIOD = 256


def draw(seed, kind):
    """The rig and the instruments of a seed, whatever the kind makes of them; all numbers are drawn in one order."""
    rng = np.random.default_rng([seed, 1])
    low, high = kind.restitution
    d = {
        "R": low + (high - low) * rng.random(),
        "beta": rng.uniform(*kind.damping),
        "f0": rng.uniform(*kind.frequency_hz),
        "xst_m": rng.uniform(*kind.deflection_m),
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
        p[rig.BY], p[rig.FY] = kind.damping_ratio_y * p[rig.BX], d["fy"] * p[rig.FX]
        p[rig.LAG_Y] = kind.force_lag_rad
        p[rig.IY] = 1.0 / p[rig.MY]
    p[rig.IX] = 1.0 / p[rig.MX]
    if kind.second_mode:
        m2 = kind.second_mode * d["m_kg"]
        p[rig.MODE_M] = m2
        p[rig.MODE_K] = m2 * (kind.second_mode_ratio * omega) ** 2
        p[rig.MODE_B] = 2.0 * 0.02 * m2 * kind.second_mode_ratio * omega
    p[rig.RESTITUTION] = d["R"]
    p[rig.SCATTER], p[rig.DRAWN] = kind.scatter, d["seed"] + 1.0
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


def natural(p, kind):
    """Natural frequency in Hz and damping ratio from eigenvalues, by definition of the README: means of both masses."""
    mode = (p[rig.MODE_M], p[rig.MODE_K], p[rig.MODE_B]) if kind.second_mode else None
    own = [rig.natural(p[rig.MX], p[rig.KX], p[rig.BX], mode)]
    if kind.machine == "double":
        own.append(rig.natural(p[rig.MY], p[rig.KY], p[rig.BY], mode))
    return math.exp(np.mean([math.log(f) for f, _ in own])), float(np.mean([b for _, b in own]))


def truth(d, kind, impacts):
    """What the campaign should find."""
    p = machine(d, kind)
    frequency_hz, damping_ratio = natural(p, kind)
    deflections = [p[rig.FX] / p[rig.KX]]
    if kind.machine == "double":
        deflections.append(p[rig.FY] / p[rig.KY])
    restitution = d["R"]
    if kind.speed_exponent and len(impacts):
        restitution = float(np.median(impacts[:, 3] / impacts[:, 1]))
    return {
        "restitution": restitution,
        "natural_frequency_hz": frequency_hz,
        "damping_ratio": damping_ratio,
        "static_deflection_m": float(np.mean(deflections)),
    }


def alternatives(d, kind, main):
    """Other values that an interval may hold: of the second half's rig, of R of the whole body."""
    if kind.other_restitution or kind.other_frequency or kind.other_damping:
        other = {**d, "R": d["R"] + kind.other_restitution, "f0": d["f0"] * (1.0 + kind.other_frequency)}
        other["beta"] *= 1.0 + kind.other_damping
        return truth(other, kind, ())
    if kind.second_mode:
        mu = kind.second_mode
        return {**main, "restitution": (d["R"] - mu) / (1.0 + mu)}
    return None
