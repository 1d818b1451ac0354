"""Instruments between the rig and the record: sensors, filters, converter, the sampler's clock.

A channel states the times at which it needs the rig's motion, and turns the motion there into the numbers of the
file. Filters act on the continuous signal: jumps at impacts pass through the filter's step response.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numba import njit

DRIVE_V = 3.0
CONTACT_V = 4.8
ROLES_OF_X = {"velocity_x": 1, "displacement_x": 0, "acceleration_x": 1}
ROLES_OF_Y = {"velocity_y": 3, "displacement_y": 2, "acceleration_y": 3}


@dataclass(frozen=True)
class Channel:
    """One channel as it is, not as campaign.toml states it."""

    role: str
    name: str
    scale: float = 1.0  # SI unit per volt, as stated
    scale_text: str = ""
    gain: float = 1.0  # true over stated
    high_passed: bool = False
    delay_s: float = 0.0
    smear: float = 0.0  # share of a sample by which software shifts readings, by straight lines between them
    low_pass: tuple = (0, 0.0)  # order and corner in Hz of a Butterworth filter
    resonance: tuple = (0.0, 0.0)  # frequency in Hz and damping ratio of the sensor's own vibration
    band_limit: float = 0.0  # corner over the sampling rate of a converter's filter of linear phase
    pickup_drive: float = 0.0  # volts per volt of the generator
    pickup_contact: float = 0.0  # volts per volt of the contact
    crosstalk: float = 0.0  # volts per volt of the other mass's channel
    slow_noise_v: float = 0.0
    slow_s: float = 1.0  # time constant of the slow noise
    hum_v: float = 0.0
    outliers: float = 0.0  # share of the samples
    noise_v: float = 0.0
    full_scale_v: float = 10.0
    bits: int = 12
    missed: float = 0.0  # share of the impacts that the contact does not show
    chatter: bool = False  # a closed contact opens twice for a moment
    wide: bool = False  # the converter's range was chosen for the spikes at impacts


@dataclass(frozen=True)
class Motion:
    """What one record's channels read from: the rig's state at sorted times, and its impacts."""

    times: np.ndarray
    states: np.ndarray
    impacts: np.ndarray
    pulse_s: float
    omega: float
    phase: float

    def at(self, times):
        """States at times that were asked for before."""
        return self.states[np.searchsorted(self.times, times)]

    def closed(self, times, chatter=False):
        """Whether the contact is closed."""
        if not len(self.impacts):
            return np.zeros(len(times), bool)
        index = np.searchsorted(self.impacts[:, 0], times, side="right") - 1
        end = np.maximum(self.impacts[:, 2], self.impacts[:, 0] + self.pulse_s)
        index, known = np.maximum(index, 0), index >= 0
        begin, end = self.impacts[index, 0], end[index]
        part = np.floor(7.0 * (times - begin) / (end - begin))
        return known & (times < end) & ~(chatter & ((part == 2) | (part == 5)))

    def without(self, share):
        """The motion without a share of its impacts, for what does not see them all."""
        kept = np.modf(1e4 * self.impacts[:, 0])[0] >= share
        return replace(self, impacts=self.impacts[kept])

    def drive_v(self, times):
        """The generator's voltage."""
        return DRIVE_V * np.cos(self.omega * times + self.phase)


def channels(d, kind):
    """The channels with their errors."""
    speed = d["xst_m"] * 2.0 * math.pi * d["f0"]
    late = dict(kind.late_s)
    result = []
    for role in kind.roles:
        name = {"drive": "generator", "contact": "contact"}.get(role, f"sensor_{role}")
        noise = 10.0 * d["noise"] * kind.noise * (1.0 if kind.bits <= 12 else 0.1)
        c = Channel(role, name, delay_s=late.get(role, 0.0), noise_v=noise, bits=kind.bits)
        if role == "contact":
            c = replace(c, missed=kind.contact_missed, chatter=kind.chatter)
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
    c = replace(c, high_passed=kind.high_pass_hidden or c.role == "velocity_y")
    if c.role[-1] in kind.low_pass_of:
        c = replace(c, low_pass=kind.low_pass)
    c = replace(c, resonance=kind.resonance)
    c = replace(c, band_limit=kind.band_limit)
    if kind.smear:
        c = replace(c, smear=kind.smear if kind.smear > 0.0 else d["smear_x"] if of_x else d["smear_y"])
    if of_x:
        c = replace(c, pickup_drive=kind.pickup_drive, pickup_contact=kind.pickup_contact)
        c = replace(c, crosstalk=kind.crosstalk, outliers=kind.outliers)
    slow_s = 10.0 / (2.0 * math.pi * d["f0"])
    return replace(c, slow_noise_v=kind.slow_noise * c.noise_v, slow_s=slow_s, hum_v=kind.hum * c.noise_v)


def times_needed(channel, ticks):
    """Times at which the channel needs the state, for samples at the given ticks."""
    if channel.role in ("drive", "contact"):
        return np.empty(0)
    period = ticks[1] - ticks[0]
    if highest_corner(channel):
        return fine_times(channel, ticks)
    if channel.band_limit:
        return dense_times(channel, ticks)
    base = ticks - channel.delay_s
    if channel.smear:
        base = base + channel.smear * period
        base = np.concatenate([[base[0] - period], base])
    if channel.role.startswith("acceleration"):
        base = np.concatenate([base - 0.5 * period, [base[-1] + 0.5 * period]])
    return base


def highest_corner(channel):
    """The highest corner or resonance of the channel's filters, Hz; 0 where it has none."""
    return max(channel.low_pass[1], channel.resonance[0])


def slowest_decay_s(channel):
    """The longest time constant of the channel's filters."""
    poles, _ = poles_and_residues(channel)
    return 1.0 / np.min(-poles.real)


def fine_parts(channel, period):
    """Parts of a sample in which the channel's filters are worked out."""
    return max(1, int(np.ceil(period * 60.0 * highest_corner(channel))))


def fine_times(channel, ticks):
    """An even grid that holds the ticks (of accelerations: the middles between them) and begins before them."""
    period = ticks[1] - ticks[0]
    parts = fine_parts(channel, period)
    lead = int(np.ceil(40.0 * slowest_decay_s(channel) / period)) + 1
    shift = 0.5 * period if channel.role.startswith("acceleration") else 0.0
    count = (lead + len(ticks) - 1 + (1 if shift else 0)) * parts + 1
    return ticks[0] - channel.delay_s - shift - lead * period + period / parts * np.arange(count)


def dense_times(channel, ticks):
    """An even grid that reaches beyond the ticks (of accelerations: the middles between them) by a band limit's half."""
    period = ticks[1] - ticks[0]
    averaged = channel.role.startswith("acceleration")
    count = (2 * BAND_HALF + len(ticks) - 1 + averaged) * BAND_PARTS + 1
    first = ticks[0] - channel.delay_s - (BAND_HALF + 0.5 * averaged) * period
    return first + period / BAND_PARTS * np.arange(count)


def quantity(channel, motion, times):
    """The measured quantity at times of which the states are known; of accelerations the velocity."""
    index = {**ROLES_OF_X, **ROLES_OF_Y}[channel.role]
    states = motion.at(times)
    value = states[:, index]
    if channel.high_passed:
        value = value - states[:, 8 if channel.role.endswith("x") else 9]
    return value


def samples(channel, motion, ticks):
    """The numbers in the file, in counts, and the size of a count in volts."""
    read_at = ticks - channel.delay_s
    if channel.role == "drive":
        volts = motion.drive_v(read_at) * channel.gain
    elif channel.role == "contact":
        volts = CONTACT_V * motion.without(channel.missed).closed(read_at, channel.chatter)
    else:
        volts = sensor(channel, motion, ticks) * channel.gain / channel.scale
        if channel.crosstalk:
            other = replace(channel, role=channel.role[:-1] + "y")
            volts = volts + channel.crosstalk * sensor(other, motion, ticks) / channel.scale
    volts = volts + channel.pickup_drive * motion.drive_v(ticks)
    return volts + channel.pickup_contact * CONTACT_V * motion.closed(ticks)


def sensor(channel, motion, ticks):
    """The quantity at the ticks behind filters, averaging and the software's shift."""
    period = ticks[1] - ticks[0]
    times = times_needed(channel, ticks)
    value = quantity(channel, motion, times)
    averaged = channel.role.startswith("acceleration")
    if highest_corner(channel):
        value = low_passed(channel, motion, times, value)
        value = value[:: fine_parts(channel, period)][-(len(ticks) + averaged) :]
    if channel.band_limit:
        value = band_limited(channel, motion, times, value)
    if averaged:
        value = np.diff(value) / period
    if channel.smear:
        value = channel.smear * value[:-1] + (1.0 - channel.smear) * value[1:]
    return value


def disturbance(channel, period, count, rng):
    """What is added to a channel beside white noise, V."""
    volts = np.zeros(count)
    if channel.slow_noise_v:
        kept = math.exp(-period / channel.slow_s)
        steps = channel.slow_noise_v * rng.standard_normal(count)
        steps[1:] *= math.sqrt(1.0 - kept * kept)
        for i in range(1, count):
            steps[i] += kept * steps[i - 1]
        volts += steps
    if channel.hum_v:
        volts += channel.hum_v * math.sqrt(2.0) * np.cos(2.0 * math.pi * (50.0 * period * np.arange(count) + rng.random()))
    if channel.outliers:
        struck = rng.random(count) < channel.outliers
        volts += 100.0 * channel.noise_v * struck * rng.choice((-1.0, 1.0), count)
    return volts


def converted(channel, volts, period, rng):
    """Counts of the converter."""
    count = channel.full_scale_v / 2 ** (channel.bits - 1)
    noisy = volts + channel.noise_v * rng.standard_normal(len(volts))
    if channel.slow_noise_v or channel.hum_v or channel.outliers:
        noisy = noisy + disturbance(channel, period, len(volts), rng)
    limit = 2 ** (channel.bits - 1)
    return np.clip(np.round(noisy / count), -limit, limit - 1).astype(np.int16 if channel.bits <= 16 else np.int32), count


FROZEN_S = 0.027


def freeze(columns, kind, rng):
    """In a share of the records all columns repeat one row for some time."""
    if rng.random() < kind.frozen:
        count = round(FROZEN_S * kind.rate_hz)
        at = int(rng.integers(0, len(columns[0]) - count))
        for counts in columns:
            counts[at : at + count] = counts[at]


def low_passed(channel, motion, times, value):
    """The channel's filters on a signal that is even between its jumps and kinks."""
    smooth = value.copy()
    poles, residues = poles_and_residues(channel)
    breaks, integrals = breaks_of(channel, motion, times)
    for at, height in breaks:
        smooth -= height * np.maximum(0.0, times - at) ** integrals * (times >= at)
    out = linear_response(smooth, times[1] - times[0], poles, residues)
    for at, height in breaks:
        since = np.maximum(0.0, times - at)
        steps = [(np.exp(p * since) - 1.0) / p for p in poles]
        if integrals:
            steps = [(step - since) / p for p, step in zip(poles, steps)]
        response = sum(r * step for r, step in zip(residues, steps))
        out += height * response.real * (times >= at)
    return out


def breaks_of(channel, motion, times):
    """Times of the impacts and the jumps of the velocity there, and whether they are kinks of what is measured."""
    index = 4 if channel.role.endswith("x") else 5
    hits = motion.impacts
    hits = hits[(hits[:, 0] > times[0]) & (hits[:, 0] < times[-1])]
    return hits[:, [0, index]], int(channel.role.startswith("displacement"))


def without_jumps(channel, motion, times, value):
    """Times and heights of a signal's jumps, and the signal without them."""
    breaks, integrals = breaks_of(channel, motion, times)
    jumps = np.zeros((0, 2)) if integrals else breaks
    smooth = value.copy()
    for at, jump in jumps:
        smooth -= jump * (times >= at)
    return jumps, smooth


BAND_HALF = 24  # samples of either half of a band limit's impulse response
BAND_PARTS = 8  # values in a sample


def band_limited(channel, motion, times, value):
    """The filter of a converter that samples far faster than it gives values (a sinc under Kaiser's window), and the
    values at the ticks: jumps ring before and behind themselves."""
    jumps, smooth = without_jumps(channel, motion, times, value)
    fine = np.linspace(-BAND_HALF, BAND_HALF, 200 * BAND_HALF * BAND_PARTS + 1)
    response = np.sinc(2.0 * channel.band_limit * fine) * np.kaiser(len(fine), 9.0)
    step = np.concatenate([[0.0], np.cumsum(0.5 * (response[1:] + response[:-1]))])
    coarse = response[:: 100]
    out = np.convolve(smooth, coarse / coarse.sum(), mode="valid")[::BAND_PARTS]
    half = BAND_HALF * BAND_PARTS
    period = BAND_PARTS * (times[1] - times[0])
    ticks = times[half : len(times) - half : BAND_PARTS]
    for at, jump in jumps:
        out += jump * np.interp((ticks - at) / period, fine, step / step[-1])
    return out


def poles_and_residues(channel):
    """Poles and residues of the Butterworth low-pass and the sensor's resonance, together of unit gain."""
    poles = np.zeros(0, complex)
    order, corner = channel.low_pass
    if order:
        j = np.arange(order)
        poles = 2.0 * np.pi * corner * np.exp(1j * np.pi * (2 * j + order + 1) / (2 * order))
    frequency, damping = channel.resonance
    if frequency:
        along = 2.0 * np.pi * frequency * np.exp(1j * np.arccos(-damping))
        poles = np.concatenate([poles, [along, along.conjugate()]])
    others = [np.prod([pole - other for other in poles if other != pole]) for pole in poles]
    return poles, np.prod(-poles) / np.array(others)


@njit(cache=True)
def linear_response(value, step, poles, residues):
    """Response of a sum of poles to samples joined by straight lines, settled at the first sample."""
    out = np.zeros(value.size)
    for j in range(poles.size):
        p, r = poles[j], residues[j]
        e = np.exp(p * step)
        a = (e - 1.0) / p
        b = (e - 1.0 - p * step) / (p * p * step)
        z = -value[0] / p + 0.0j
        out[0] += (r * z).real
        for i in range(1, value.size):
            z = e * z + a * value[i - 1] + b * (value[i] - value[i - 1])
            out[i] += (r * z).real
    return out
