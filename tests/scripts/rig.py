"""Motion of two masses on springs that hit each other, or of one mass against a stop.

Every mass has its own m, k, b and F, in SI units; nothing is scaled by a natural frequency or by a
static deflection. The equations of motion are integrated by the Runge-Kutta method of fourth order in
small fixed steps. First touch, end of contact, end of sticking and each sample are located within a
step by repeating the step with another length, so no step crosses an impact. x and y are positive
toward the other mass; a contact is closed where x + y > gap. A stop is a mass y that never moves.
"""

import math

import numpy as np
from numba import njit

# Indices of the array of parameters that the integrator is given.
(MX, BX, KX, FX, MY, BY, KY, FY, IX, IY, HARDENING, FRICTION, SPEED_OF_FRICTION, A2, PHI2, A3, PHI3, GAP, OMEGA,
 PHASE, LAW, CONTACT_K, CONTACT_C, RESTITUTION, SPEED_EXPONENT, SPEED_REFERENCE, CORNER_X, CORNER_Y, MODE_M,
 MODE_K, MODE_B, STEP, CONTACT_STEP, STICK_SPEED, TOUCH_SPEED, LAG_Y, SCATTER, DRAWN) = range(38)
PARAMETERS = 38
# The state: x, x', y, y', the second mode's mass in x and in y, and what a high-pass takes off x' and y'.
STATES = 10
RIGID, SPRING_DAMPER, HUNT_CROSSLEY = 0.0, 1.0, 2.0


@njit(cache=True)
def press(u, w, p):
    """Force in a contact of finite stiffness at overlap u and closing speed w; it only presses.

    The damping of Hunt and Crossley's contact is that over the approach speed of the present impact, so that its
    restitution is the same at every speed; only its duration changes.
    """
    if u <= 0.0:
        return 0.0
    if p[LAW] == SPRING_DAMPER:
        force = p[CONTACT_K] * u + p[CONTACT_C] * w
    else:
        force = p[CONTACT_K] * u * math.sqrt(u) * (1.0 + p[CONTACT_C] * w / p[TOUCH_SPEED])
    return max(0.0, force)


@njit(cache=True)
def drive(theta, p):
    """Course of a force over its amplitude."""
    course = math.cos(theta)
    if p[A2] != 0.0 or p[A3] != 0.0:
        course += p[A2] * math.cos(2.0 * theta + p[PHI2]) + p[A3] * math.cos(3.0 * theta + p[PHI3])
    return course


@njit(cache=True)
def applied(position, speed, force, k, b, p):
    """Force of drive, spring, dashpot and friction on one mass."""
    total = force - k * position * (1.0 + p[HARDENING] * position * position) - b * speed
    if p[FRICTION] != 0.0:
        total -= p[FRICTION] * math.tanh(speed / p[SPEED_OF_FRICTION])
    return total


@njit(cache=True)
def sticking_force(t, s, p):
    """Force that keeps both masses together; negative: they part."""
    d = np.empty(STATES)
    slope(t, s, p, False, d)
    return (d[1] + d[3]) / (p[IX] + p[IY])


@njit(cache=True)
def slope(t, s, p, stuck, d):
    """Time derivative of the state into d."""
    theta = p[OMEGA] * t + p[PHASE]
    fx = applied(s[0], s[1], p[FX] * drive(theta, p), p[KX], p[BX], p)
    fy = applied(s[2], s[3], p[FY] * drive(theta - p[LAG_Y], p), p[KY], p[BY], p)
    for i in range(STATES):
        d[i] = 0.0
    if p[MODE_M] > 0.0:
        cx = p[MODE_K] * (s[0] - s[4]) + p[MODE_B] * (s[1] - s[5])
        cy = p[MODE_K] * (s[2] - s[6]) + p[MODE_B] * (s[3] - s[7])
        fx -= cx
        fy -= cy
        d[4] = s[5]
        d[5] = cx / p[MODE_M]
        d[6] = s[7]
        d[7] = cy / p[MODE_M]
    if p[LAW] != RIGID:
        force = press(s[0] + s[2] - p[GAP], s[1] + s[3], p)
        fx -= force
        fy -= force
    if stuck:
        force = (fx * p[IX] + fy * p[IY]) / (p[IX] + p[IY])
        fx -= force
        fy -= force
    d[0] = s[1]
    d[1] = fx * p[IX]
    d[2] = s[3]
    d[3] = fy * p[IY]
    d[8] = p[CORNER_X] * (s[1] - s[8])
    d[9] = p[CORNER_Y] * (s[3] - s[9])


@njit(cache=True)
def advance(t, h, s, p, stuck, k, out):
    """One step of the Runge-Kutta method from s into out; k is room for 5 states."""
    slope(t, s, p, stuck, k[0])
    for i in range(STATES):
        k[4, i] = s[i] + 0.5 * h * k[0, i]
    slope(t + 0.5 * h, k[4], p, stuck, k[1])
    for i in range(STATES):
        k[4, i] = s[i] + 0.5 * h * k[1, i]
    slope(t + 0.5 * h, k[4], p, stuck, k[2])
    for i in range(STATES):
        k[4, i] = s[i] + h * k[2, i]
    slope(t + h, k[4], p, stuck, k[3])
    for i in range(STATES):
        out[i] = s[i] + h / 6.0 * (k[0, i] + 2.0 * k[1, i] + 2.0 * k[2, i] + k[3, i])


# What is looked for within a step.
TOUCH, TURN, PART = 0, 1, 2


@njit(cache=True)
def watched(what, t, s, p):
    """The quantity whose change of sign is looked for: positive beyond the event."""
    if what == TOUCH:
        return s[0] + s[2] - p[GAP]
    if what == TURN:
        return -(s[1] + s[3])
    return -sticking_force(t, s, p)


@njit(cache=True)
def locate(what, t, h, s, p, stuck, k, out):
    """Length of the part of the step after which the event has just happened; the state there in out."""
    low, high = 0.0, h
    for _ in range(60):
        middle = 0.5 * (low + high)
        if middle <= low or middle >= high:
            break
        advance(t, middle, s, p, stuck, k, out)
        if watched(what, t + middle, out, p) > 0.0:
            high = middle
        else:
            low = middle
    advance(t, high, s, p, stuck, k, out)
    return high


@njit(cache=True)
def restitution_at(w, p):
    """Restitution of a rigid impact at the approach speed w; where it scatters, the next one that is drawn."""
    restitution = p[RESTITUTION] * (1.0 + p[SCATTER] * drawn(p))
    if p[SPEED_EXPONENT] == 0.0:
        return restitution
    return max(0.0, 1.0 - (1.0 - restitution) * (w / p[SPEED_REFERENCE]) ** p[SPEED_EXPONENT])


@njit(cache=True)
def drawn(p):
    """The next of pseudorandom numbers of mean 0 and deviation 1: the sum of four even ones."""
    if p[SCATTER] == 0.0:
        return 0.0
    total = 0.0
    for _ in range(4):
        p[DRAWN] = (1103515245.0 * p[DRAWN] + 12345.0) % 2147483648.0
        total += p[DRAWN] / 2147483648.0 - 0.5
    return total * math.sqrt(3.0)


@njit(cache=True)
def strike(s, p, restitution):
    """Newton's impact: the relative velocity turns, the momentum stays."""
    w = s[1] + s[3]
    impulse = (1.0 + restitution) * w / (p[IX] + p[IY])
    s[1] -= impulse * p[IX]
    s[3] -= impulse * p[IY]


@njit(cache=True)
def first_touch(t, h, s, p, k, trial):
    """Length of the part of the step until the gap closes, or -1; trial holds the state after h."""
    if trial[0] + trial[2] > p[GAP]:
        return locate(TOUCH, t, h, s, p, False, k, trial)
    if s[1] + s[3] > 0.0 and trial[1] + trial[3] < 0.0:
        turn = locate(TURN, t, h, s, p, False, k, trial)
        if trial[0] + trial[2] > p[GAP]:
            return locate(TOUCH, t, turn, s, p, False, k, trial)
        advance(t, h, s, p, False, k, trial)
    return -1.0


@njit(cache=True)
def move(s, t, end, p, stuck, times, states, impacts):
    """Moves the state s from t to end; returns whether the masses stick there and the number of impacts.

    states receives the state at each of the sorted times, impacts rows of: first touch, approach speed, end of
    contact, separation speed, change of x' and of y'.
    """
    k = np.empty((5, STATES))
    trial = np.empty(STATES)
    n_out, n = 0, 0
    shortest = p[STEP]
    closed = p[LAW] != RIGID and s[0] + s[2] > p[GAP]
    pressing = False
    while t < end:
        h = min(p[CONTACT_STEP] if closed else p[STEP], end - t, shortest)
        shortest = p[STEP]
        advance(t, h, s, p, stuck, k, trial)
        event = -1
        if stuck:
            if sticking_force(t + h, trial, p) < 0.0:
                h = locate(PART, t, h, s, p, True, k, trial)
                event = PART
        elif not closed:
            touch = first_touch(t, h, s, p, k, trial)
            if touch >= 0.0:
                h = touch
                event = TOUCH
        while n_out < times.size and times[n_out] <= t + h:
            advance(t, max(0.0, times[n_out] - t), s, p, stuck, k, states[n_out])
            n_out += 1
        s[:] = trial
        t += h
        w = s[1] + s[3]
        if event == PART:
            stuck = False
        elif closed:
            u = s[0] + s[2] - p[GAP]
            if pressing and w < 0.0 and press(u, w, p) <= 0.0 and n <= impacts.shape[0]:
                impacts[n - 1, 2] = t
                impacts[n - 1, 3] = -w
                pressing = False
            closed = u > 0.0
        elif event == TOUCH:
            if n == impacts.shape[0]:
                return stuck, -1
            impacts[n, 0] = t
            impacts[n, 1] = w
            impacts[n, 2] = t
            if p[LAW] != RIGID:
                closed = True
                p[TOUCH_SPEED] = max(w, p[STICK_SPEED])
                pressing = True
                impacts[n, 3:] = 0.0
            else:
                before_x, before_y = s[1], s[3]
                strike(s, p, restitution_at(w, p))
                approach = sticking_force(t, s, p) * (p[IX] + p[IY])
                after = -(s[1] + s[3])
                if after < p[STICK_SPEED] and approach > 0.0:
                    strike(s, p, 0.0)
                    stuck = True
                elif approach > 0.0:
                    shortest = max(1e-12, after / approach)
                impacts[n, 3] = after
                impacts[n, 4] = s[1] - before_x
                impacts[n, 5] = s[3] - before_y
            n += 1
    return stuck, n


def natural(m, k, b, mode=None):
    """Natural frequency in Hz and damping ratio of a mass's first mode, from the eigenvalues of its equations."""
    if mode is None:
        matrix = np.array([[0.0, 1.0], [-k / m, -b / m]])
    else:
        m2, k2, b2 = mode
        matrix = np.array([
            [0.0, 1.0, 0.0, 0.0],
            [-(k + k2) / m, -(b + b2) / m, k2 / m, b2 / m],
            [0.0, 0.0, 0.0, 1.0],
            [k2 / m2, b2 / m2, -k2 / m2, -b2 / m2],
        ])
    values = np.linalg.eigvals(matrix)
    first = values[np.argmin(np.abs(values))]
    return float(abs(first) / (2.0 * math.pi)), float(-first.real / abs(first))


def contact_alone(law, k, c, mass, speed):
    """Restitution and duration of a contact of the reduced mass at an approach speed, nothing else acting."""
    p = np.zeros(PARAMETERS)
    p[LAW], p[CONTACT_K], p[CONTACT_C] = law, k, c
    p[IX] = 1.0 / mass
    length = math.pi * math.sqrt(mass / k) if law == SPRING_DAMPER else 2.9 * (mass**2 / (k**2 * speed)) ** 0.2
    p[STEP] = p[CONTACT_STEP] = length / 400.0
    p[TOUCH_SPEED] = speed
    s = np.zeros(STATES)
    s[0], s[1] = 1e-18, speed
    t = 0.0
    h = p[CONTACT_STEP]
    room, out = np.empty((5, STATES)), np.empty(STATES)
    while True:
        advance(t, h, s, p, False, room, out)
        if out[1] < 0.0 and press(out[0], out[1], p) <= 0.0:
            # The press ends within the step: its end by halving.
            low, high = 0.0, h
            for _ in range(50):
                middle = 0.5 * (low + high)
                advance(t, middle, s, p, False, room, out)
                if out[1] < 0.0 and press(out[0], out[1], p) <= 0.0:
                    high = middle
                else:
                    low = middle
            return -out[1] / speed, t + high
        s[:] = out
        t += h


def contact_for(law, restitution, duration, mass, speed):
    """Stiffness and damping of a contact with this restitution and duration at this approach speed."""
    k = mass * (math.pi / duration) ** 2
    if law == HUNT_CROSSLEY:
        k = mass * (2.9 / duration) ** 2.5 * speed**-0.5
    c = 0.0
    for _ in range(6):
        scale = 2.0 * math.sqrt(mass * k) if law == SPRING_DAMPER else 20.0
        low, high = 0.0, scale
        for _ in range(40):
            c = 0.5 * (low + high)
            if contact_alone(law, k, c, mass, speed)[0] > restitution:
                low = c
            else:
                high = c
        length = contact_alone(law, k, c, mass, speed)[1]
        k *= (length / duration) ** (2.0 if law == SPRING_DAMPER else 2.5)
        if abs(length / duration - 1.0) < 1e-9:
            break
    return k, c
