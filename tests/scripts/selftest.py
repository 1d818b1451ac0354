"""The simulator against closed forms and published numbers; `laboratory.py --selftest` runs it."""

import functools
import math

import numpy as np

import closed_form
import instruments
import rig


def symmetric(beta, restitution, rho, eta, phase=0.0, steps=400):
    """Two equal masses with m = 2 kg, f0 = 3 Hz and x_st = 5 mm, and the units of length and time."""
    m, omega, deflection = 2.0, 6.0 * math.pi, 5e-3
    p = np.zeros(rig.PARAMETERS)
    for mass, spring, dashpot, force in ((rig.MX, rig.KX, rig.BX, rig.FX), (rig.MY, rig.KY, rig.BY, rig.FY)):
        p[mass], p[spring], p[dashpot] = m, m * omega**2, 2.0 * beta * m * omega
        p[force] = p[spring] * deflection
    p[rig.IX] = p[rig.IY] = 1.0 / m
    p[rig.GAP], p[rig.OMEGA], p[rig.PHASE] = 2.0 * rho * deflection, eta * omega, phase
    p[rig.RESTITUTION], p[rig.STICK_SPEED] = restitution, 1e-8 * deflection * omega
    p[rig.STEP] = 2.0 * math.pi / omega / steps
    return p, deflection, omega


def moved(p, s, seconds):
    """The impacts of a motion that begins in s, which moves on."""
    impacts = np.empty((100_000, 6))
    stuck, n = rig.move(s, 0.0, seconds, p, False, np.empty(0), np.empty((0, rig.STATES)), impacts)
    p[rig.PHASE] += p[rig.OMEGA] * seconds
    return impacts[:n]


def check(name, found, expected, tolerance):
    """Prints one comparison; raises where it fails."""
    worst = float(np.max(np.abs(np.asarray(found) - np.asarray(expected))))
    print(f"{name:58} off by {worst:.1e}, at most {tolerance:.0e}")
    if not worst <= tolerance:
        raise SystemExit(f"{name}: {found} is not {expected}")


def plastic_impacts():
    """Fig. 2 of the paper: four plastic impacts in three periods, three with dead zones."""
    p, deflection, omega = symmetric(0.1, 0.0, 0.7, 0.95, math.pi / 4.0)
    s = np.zeros(rig.STATES)
    s[:4] = np.array([-1.0, 1.5 * omega, -3.0, 2.5 * omega]) * deflection
    hits = moved(p, s, 3.0 * 2.0 * math.pi / (0.95 * omega))
    check("times of the impacts of Fig. 2", hits[:, 0] * 0.95 * omega / (2.0 * math.pi), [0.1589, 0.8846, 1.8677, 2.8677], 1e-4)
    check("approach speeds of Fig. 2", hits[:, 1] / (deflection * omega), [4.9422, 4.6027, 4.4129, 4.4129], 6e-5)


def orbits():
    """Approach speeds of z = 1 and where it ends."""
    for eta, rho, beta, restitution in ((1.2, 2.0, 0.07, 0.9), (1.1, 3.0, 0.02, 0.3), (1.5, 1.2, 0.05, 0.7)):
        p, deflection, omega = symmetric(beta, restitution, rho, eta)
        hits = moved(p, np.zeros(rig.STATES), 400.0 * 2.0 * math.pi / omega)
        speeds = closed_form.approach_speeds(eta, rho, beta, restitution)
        found = hits[-1, 1] / (2.0 * deflection * omega)
        check(f"approach speed of z = 1, eta {eta}, R {restitution}", found, min(speeds, key=lambda v: abs(v - found)), 2e-8)
    check("closed form at eta 1.2", max(closed_form.approach_speeds(1.2, 2.0, 0.07, 0.9)), 2.413516, 1e-6)
    check("closed form at eta 1.1", 2.0 * max(closed_form.approach_speeds(1.1, 3.0, 0.02, 0.3)), 6.534558, 1e-6)
    check("saddle-nodes", [closed_form.saddle_node(e, 0.07, 0.9) for e in (1.1, 1.3, 1.6)], [6.351142, 4.151754, 1.812702], 1e-6)
    p, deflection, omega = symmetric(0.07, 0.9, 1.2, 1.3)
    s, low, rho, step = np.zeros(rig.STATES), 1.2, 1.2, 0.1
    while step > 1e-4:
        p[rig.GAP] = 2.0 * rho * deflection
        trial, phase = s.copy(), p[rig.PHASE]
        lasts = len(moved(p, trial, 300.0 * 2.0 * math.pi / omega)) > 150
        if lasts:
            s, low = trial, rho
        else:
            p[rig.PHASE], step = phase, step / 4.0
        rho = low + step
    check("z = 1 ends at its saddle-node, eta 1.3", low, 4.151754, 4e-4)


def resonance():
    """Amplitudes without impacts, eigenvalues, and that halved steps change nothing."""
    for eta in (0.7, 1.0, 1.6):
        p, deflection, omega = symmetric(0.05, 0.9, 100.0, eta)
        s = np.zeros(rig.STATES)
        moved(p, s, 100.0 * 2.0 * math.pi / omega)
        times = np.linspace(1e-6, 2.0 * math.pi / (eta * omega), 400)
        states = np.empty((400, rig.STATES))
        rig.move(s, 0.0, times[-1], p, False, times, states, np.empty((9, 6)))
        check(f"resonance curve at eta {eta}", np.ptp(states[:, 0]) / 2.0 / deflection, closed_form.amplitude(eta, 0.05), 1e-4)
    omega = math.sqrt(700.0 / 1.3)
    check("eigenvalues", rig.natural(1.3, 700.0, 2.0), [omega / (2.0 * math.pi), 2.0 / (2.0 * 1.3 * omega)], 1e-12)
    ends = []
    for steps in (256, 2048):
        p, deflection, omega = symmetric(0.05, 0.7, 1.2, 1.5, steps=steps)
        s = np.zeros(rig.STATES)
        moved(p, s, 10.0)
        ends.append(s[0] / deflection)
    check("steps eight times shorter", ends[0], ends[1], 1e-7)


def contacts():
    """Contacts of finite stiffness have the restitution and duration asked for, and short ones act as rigid ones."""
    for law in (rig.SPRING_DAMPER, rig.HUNT_CROSSLEY):
        k, c = rig.contact_for(law, 0.75, 5e-4, 0.8, 0.3)
        check("contact of finite stiffness: R", rig.contact_alone(law, k, c, 0.8, 0.3)[0], 0.75, 1e-8)
        check("contact of finite stiffness: duration", rig.contact_alone(law, k, c, 0.8, 0.3)[1], 5e-4, 1e-10)
    k, c = rig.contact_for(rig.SPRING_DAMPER, 0.75, 5e-4, 0.8, 0.3)
    zeta = c / (2.0 * math.sqrt(0.8 * k))
    angle = math.pi - 2.0 * math.asin(zeta)
    check("R of the spring and damper", math.exp(-angle * zeta / math.sqrt(1.0 - zeta**2)), 0.75, 1e-8)
    p, deflection, omega = symmetric(0.07, 0.9, 2.0, 1.2)
    speed = 2.4135 * 2.0 * deflection * omega
    p[rig.LAW], p[rig.CONTACT_STEP] = rig.SPRING_DAMPER, 1e-7
    p[rig.CONTACT_K], p[rig.CONTACT_C] = rig.contact_for(rig.SPRING_DAMPER, 0.9, 1e-5, 1.0, speed)
    hits = moved(p, np.zeros(rig.STATES), 300.0 * 2.0 * math.pi / omega)
    check("a contact of 10 us acts as a rigid one", hits[-2, 1] / (2.0 * deflection * omega), 2.413516, 2e-3)
    check("its restitution", hits[-2, 3] / hits[-2, 1], 0.9, 2e-3)


def filters():
    """The filter that works on samples and jumps against one that is integrated with the motion."""
    corner = 40.0
    p, deflection, omega = symmetric(0.05, 0.7, 1.2, 1.5)
    p[rig.CORNER_X] = p[rig.CORNER_Y] = 2.0 * math.pi * corner
    ticks = 20.0 + np.arange(800) / 2000.0
    channel = functools.partial(instruments.Channel, "velocity_x", "v")
    integrator = channel(low_pass=(1, corner))
    times = instruments.times_needed(integrator, ticks)
    states, impacts = np.empty((len(times), rig.STATES)), np.empty((1000, 6))
    _, n = rig.move(np.zeros(rig.STATES), 0.0, times[-1] + 1e-9, p, False, times, states, impacts)
    motion = instruments.Motion(times, states, impacts[:n], 5e-4, p[rig.OMEGA], p[rig.PHASE])
    integrated = motion.at(times)[np.searchsorted(times, ticks - 1e-9), 8]
    size = deflection * omega
    check("low-pass of order 1", instruments.sensor(integrator, motion, ticks) / size, integrated / size, 1e-4)
    gains_of = {"gain of a Butterworth filter at 0 and its corner": (channel(low_pass=(4, 200.0)), math.sqrt(0.5)),
        "gain of a sensor at 0 and its resonance": (channel(resonance=(200.0, 0.02)), 25.0)}
    for name, (filtered, at_corner) in gains_of.items():
        poles, residues = instruments.poles_and_residues(filtered)
        gains = [abs(sum(residues / (2j * math.pi * frequency - poles))) for frequency in (0.0, 200.0)]
        check(name, gains, [1.0, at_corner], 1e-12)


def band_limit():
    """The filter of a delta-sigma converter passes a tone below its corner and takes away one above half the rate."""
    channel = instruments.Channel("velocity_x", "v", band_limit=0.48)
    ticks = 20.0 + np.arange(200) / 2000.0
    times = instruments.times_needed(channel, ticks)
    for frequency, passed in [(300.0, 1.0), (1200.0, 0.0)]:
        states = np.zeros((len(times), rig.STATES))
        states[:, 1] = np.cos(2.0 * math.pi * frequency * times)
        motion = instruments.Motion(times, states, np.zeros((0, 6)), 5e-4, 80.0, 0.0)
        expected = passed * np.cos(2.0 * math.pi * frequency * ticks)
        check(f"a tone of {frequency:g} Hz", instruments.sensor(channel, motion, ticks), expected, 1e-4)


def run():
    """All checks."""
    plastic_impacts()
    orbits()
    resonance()
    contacts()
    filters()
    band_limit()
    print("all met")
