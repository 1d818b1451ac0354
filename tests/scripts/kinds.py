"""Kinds of campaigns: what is special about a laboratory, one kind for each row of the table that `coverage_study.py` prints."""

from dataclasses import dataclass, replace

BOTH = ("drive", "contact", "velocity_x", "velocity_y")


@dataclass(frozen=True)
class Kind:
    """A laboratory. The defaults are the typical campaign: 72 records of an exact rig at 2 kHz."""

    about: str = "typical"
    # what is recorded
    rate_hz: float = 2000.0
    duration_s: float = 1.0
    settle_s: float = 8.0
    roles: tuple = BOTH
    bits: int = 12
    spikes_fit: bool = True  # the range of accelerations holds the spikes at impacts
    frequency_stated: bool = True
    # the settings
    clearances: tuple = (0.5, 1.0, 1.7)  # over the static deflection
    lowest: float = 0.8  # over f0
    highest: float = 2.01
    frequencies: int = 12
    boundary_step: float = 0.0  # steps of frequency around the boundaries, over f0, instead of the sweeps
    select: str = "all"  # "z0": impactless records alone; "few": two with impacts and six without
    # the rig
    machine: str = "double"
    restitution: tuple = (0.6, 0.9)
    frequency_hz: tuple = (11.0, 16.0)
    damping: tuple = (0.03, 0.09)
    deflection_m: tuple = (0.5e-3, 1.5e-3)  # by the amplitude of the force, static
    mass_ratio: float = 1.0  # of y over x
    masses_stated: bool = False
    stiffness_ratio: float = 0.0  # of y over x; 0: drawn
    force_ratio: float = 0.0  # of y over x; 0: drawn
    damping_ratio_y: float = 1.0  # of y over x
    force_lag_rad: float = 0.0  # by which the force on y follows that on x
    force_power: float = 0.0  # the forces rise with this power of the frequency
    speed_exponent: float = 0.0  # 1 - R rises with this power of the approach speed
    scatter: float = 0.0  # of R from impact to impact, relative
    contact: str = "rigid"  # "spring-damper", "hunt-crossley"
    contact_s: float = 6.4e-4
    second_mode: float = 0.0  # mass of the second mode over that of the part that is struck
    second_mode_ratio: float = 12.0  # its frequency over f0
    effects: float = 0.0  # hardening, friction, a distorted drive and a force slope, in typical strengths
    other_of: str = "half"  # which records are of another rig: the second "half", the second "gap", the "sweep" down
    other_restitution: float = 0.0  # what R of the other rig has beside the first
    other_frequency: float = 0.0  # the same of f0, relative
    other_damping: float = 0.0  # the same of beta, relative
    gap_off_m: float = 0.0  # by how much the second clearance is larger than stated
    # instruments that are off
    gain_x: float = 1.0
    gain_step: float = 0.0  # by how much the gain of x is larger in the second half, relative
    gain_drift: float = 0.0  # by how much it rises from the first record to the last, relative
    clock: float = 0.0  # relative error of the sampler's period
    late_s: tuple = ()  # (role, s) pairs
    low_pass: tuple = (0, 0.0)  # order and corner in Hz, of the channels of motion
    low_pass_stated: bool = False
    resonance: tuple = (0.0, 0.0)  # frequency in Hz and damping ratio of each sensor's own vibration
    low_pass_of: str = "xy"  # the channels of motion that it has
    frozen: float = 0.0  # share of the records in which the converter repeats a value for some time
    band_limit: float = 0.0  # corner over the rate of the filter of linear phase in a delta-sigma converter
    high_pass_hidden: bool = False  # both channels of motion behind the high-pass, which is not stated
    noise: float = 1.0  # over that of the typical converter
    contact_missed: float = 0.0  # share of the impacts that the contact does not show
    chatter: bool = False  # a closed contact opens twice for a moment
    smear: float = 0.0  # share of a sample by which software shifts readings; -1: drawn for each channel
    pickup_drive: float = 0.0
    pickup_contact: float = 0.0
    crosstalk: float = 0.0  # what x picks up of the same sensor of y
    slow_noise: float = 0.0  # noise of all channels of motion slower than a tenth of f0, over the white one
    hum: float = 0.0  # of 50 Hz in all channels of motion, over the noise
    outliers: float = 0.0  # share of the samples of x that are off by a hundred times the noise


DISPLACEMENTS = ("drive", "displacement_x", "displacement_y")
ACCELERATIONS = ("drive", "acceleration_x", "acceleration_y")
ONE_MASS = replace(Kind(), machine="single", clearances=(0.6, 1.2, 2.0))

KINDS = {
    "typical": Kind(),
    "rate_300": Kind("0.3 kHz", rate_hz=300.0),
    "rate_1k": Kind("1 kHz", rate_hz=1e3),
    "rate_5k": Kind("5 kHz", rate_hz=5e3),
    "rate_10k": Kind("10 kHz", rate_hz=1e4),
    "rate_20k": Kind("20 kHz", rate_hz=2e4),
    "rate_50k": Kind("50 kHz", rate_hz=5e4),
    "long": Kind("10 s records", duration_s=10.0),
    "displacements": Kind("displacements alone", roles=DISPLACEMENTS),
    "accelerations": Kind("accelerations alone", roles=ACCELERATIONS, bits=16),
    "accelerations_clipped": Kind("the same, spikes clipped", roles=ACCELERATIONS, bits=16, spikes_fit=False),
    "accel_contact": Kind("accelerations and contact", roles=("drive", "contact", *ACCELERATIONS[1:]), bits=16),
    "accel_contact_clipped": Kind(
        "the same, spikes clipped", roles=("drive", "contact", *ACCELERATIONS[1:]), bits=16, spikes_fit=False
    ),
    "one_velocity": Kind("two masses, velocity of x and contact", roles=BOTH[:3]),
    "one_displacement": Kind("two masses, displacement of x and contact", roles=("drive", "contact", "displacement_x")),
    "mass_10": Kind("mass y 10 % heavier", mass_ratio=1.1),
    "mass_10_stated": Kind("the same, masses stated", mass_ratio=1.1, masses_stated=True),
    "stiffness_6": Kind("spring y 6 % stiffer", stiffness_ratio=1.06, force_ratio=1.0),
    "single": replace(ONE_MASS, about="one mass against a stop, velocity", roles=("drive", "contact", "velocity_x")),
    "single_displacement": replace(
        ONE_MASS, about="one mass, velocity and displacement", roles=("drive", "contact", "velocity_x", "displacement_x")
    ),
    "single_acceleration": replace(
        ONE_MASS, about="one mass, acceleration without contact", roles=("drive", "acceleration_x"), bits=16
    ),
    "single_gain": replace(
        ONE_MASS, about="one mass against a stop, its gain off by 10 %", roles=("drive", "contact", "velocity_x"), gain_x=1.1
    ),
    "clock_1": Kind("clock off by 50 ppm", clock=5e-5),
    "clock_10": Kind("clock off by 500 ppm", clock=5e-4),
    "clock_20": Kind("clock off by 0.1 %", clock=1e-3),
    "gain_1": Kind("a gain off by 0.5 %", gain_x=1.005),
    "gain_10": Kind("a gain off by 5 %", gain_x=1.05),
    "gain_40": Kind("a gain off by 20 %", gain_x=1.2),
    "gain_step": Kind("the gain of x rises by 3 % in the middle", gain_step=0.03),
    "gain_drift": Kind("the gain of x rises by 2 % over the campaign", gain_drift=0.02),
    "gain_half": Kind("a gain off by half", gain_x=0.5),
    "gap_1": Kind("one clearance off by 0.01 mm", gap_off_m=1e-5),
    "gap_10": Kind("one clearance off by 0.1 mm", gap_off_m=1e-4),
    "late_1": Kind("velocity x late by half a sample", late_s=(("velocity_x", 2.5e-4),)),
    "late_6": Kind("velocity x late by three samples", late_s=(("velocity_x", 1.5e-3),)),
    "late_10": Kind("velocity x late by five samples", late_s=(("velocity_x", 2.5e-3),)),
    "late_both": Kind("both velocities late by three samples", late_s=(("velocity_x", 1.5e-3), ("velocity_y", 1.5e-3))),
    "late_drive": Kind("drive late by 5 ms", late_s=(("drive", 5e-3),)),
    "late_drive_20": Kind("drive late by 20 ms", late_s=(("drive", 2e-2),)),
    "late_contact": Kind("contact late by 2 ms", late_s=(("contact", 2e-3),)),
    "low_pass_200": Kind("velocities behind a low-pass of order 2 at 200 Hz", low_pass=(2, 200.0)),
    "low_pass_200_1": Kind("the same of order 1", low_pass=(1, 200.0)),
    "low_pass_800": Kind("velocities behind an anti-alias filter of order 4 at 800 Hz", low_pass=(4, 800.0)),
    "low_pass_stated": Kind("low-pass of order 2 at 200 Hz, stated", low_pass=(2, 200.0), low_pass_stated=True),
    "low_pass_1300": Kind("an anti-alias filter of order 4 at 1.3 kHz, 10 kHz", low_pass=(4, 1300.0), rate_hz=1e4),
    "low_pass_4000": Kind("an anti-alias filter of order 8 at 4 kHz, 10 kHz", low_pass=(8, 4000.0), rate_hz=1e4),
    "low_pass_one": Kind(
        "displacement x behind a low-pass of order 2 at 70 Hz", roles=DISPLACEMENTS, low_pass=(2, 70.0), low_pass_of="x"
    ),
    "delta_sigma": Kind("velocities from a delta-sigma converter", band_limit=0.48, bits=24),
    "delta_sigma_10k": Kind("the same at 10 kHz", band_limit=0.48, bits=24, rate_hz=1e4),
    "delta_sigma_displacement": Kind("displacements from such a converter", roles=DISPLACEMENTS, band_limit=0.48, bits=24),
    "delta_sigma_acceleration": Kind("accelerations from such a converter", roles=ACCELERATIONS, band_limit=0.48, bits=24),
    "smeared": Kind("jumps smeared over two samples by software", smear=-1.0),
    "smeared_half": Kind("readings averaged with the one before", smear=0.5),
    "pickup_drive": Kind("velocity x picks up 0.3 % of the generator", pickup_drive=3e-3),
    "pickup_contact": Kind("velocity x picks up 0.3 % of the contact", pickup_contact=3e-3),
    "pickup_drive_large": Kind("velocity x picks up 2 % of the generator", pickup_drive=2e-2),
    "high_pass_hidden": Kind("both velocities behind a high-pass of 0.4 Hz that is not stated", high_pass_hidden=True),
    "accel_high_pass_hidden": Kind(
        "accelerometers behind a high-pass that is not stated", roles=("drive", "contact", *ACCELERATIONS[1:]), bits=16, high_pass_hidden=True
    ),
    "accel_resonance": Kind(
        "accelerometers that resonate at 5 kHz, 20 kHz", roles=("drive", "contact", *ACCELERATIONS[1:]), bits=16, rate_hz=2e4, resonance=(5e3, 0.02)
    ),
    "piezo": Kind(
        "the same at 2 kHz behind a high-pass that is not stated", roles=("drive", "contact", *ACCELERATIONS[1:]), bits=16,
        high_pass_hidden=True, resonance=(5e3, 0.02),
    ),
    "noise_10": Kind("ten times the noise", noise=10.0),
    "bits_8": Kind("a converter of 8 bits", bits=8),
    "contact_missed": Kind("the contact misses 5 % of the impacts", contact_missed=0.05),
    "frozen": Kind("a quarter of the records repeats a value for 27 ms", frozen=0.25),
    "chatter": Kind("the contact chatters", chatter=True),
    "damping_y": Kind("mass y damped 1.5 times as much", damping_ratio_y=1.5),
    "force_y_fifth": Kind("mass y driven by a fifth of the force", force_ratio=0.2),
    "force_x_alone": Kind("mass y not driven at all", force_ratio=1e-9),
    "force_lag": Kind("the force on y lags by 0.05 rad", force_lag_rad=0.05),
    "force_square": Kind("forces as the square of the frequency", force_power=2.0),
    "force_inverse": Kind("forces as the inverse of the frequency", force_power=-1.0),
    "speed": Kind("R falls with speed", speed_exponent=0.2),
    "scatter": Kind("R scatters by 1.5 % from impact to impact", scatter=0.015),
    "scatter_displacements": Kind("the same, displacements alone", scatter=0.015, roles=DISPLACEMENTS),
    "speed_mild": Kind("R falls with speed, mildly", speed_exponent=0.05),
    "contact_linear": Kind("contacts of 0.64 ms, spring and damper", contact="spring-damper"),
    "contact_hunt": Kind("contacts of 0.64 ms, Hunt and Crossley", contact="hunt-crossley"),
    "contact_short": Kind("contacts of 0.2 ms, spring and damper", contact="spring-damper", contact_s=2e-4),
    "mode": Kind("a second mode in each mass", second_mode=0.006),
    "effects": Kind("hardening, friction, distorted drive, force slope", effects=1.0),
    "half_other": Kind("second half on another rig: R -0.04, f0 +1 %", other_restitution=-0.04, other_frequency=0.01),
    "half_restitution": Kind("second half: R -0.04", other_restitution=-0.04),
    "half_frequency": Kind("second half: f0 +1 %", other_frequency=0.01),
    "half_other_large": Kind("second half: R -0.1, f0 +7 %", other_restitution=-0.1, other_frequency=0.07),
    "gap_other": Kind("second clearance: R -0.04, f0 +1 %", other_of="gap", other_restitution=-0.04, other_frequency=0.01),
    "sweep_other": Kind("sweeps down: R -0.04, f0 +1 %", other_of="sweep", other_restitution=-0.04, other_frequency=0.01),
    "unsettled": Kind("records begin at once, nothing has settled", settle_s=0.0),
    "unsettled_half": Kind("records begin after 1.5 s", settle_s=1.5),
    "z0_only": Kind("impactless records alone", select="z0"),
    "no_drive": Kind("no drive channel, no frequency", roles=BOTH[1:], frequency_stated=False),
    "no_drive_stated": Kind("no drive channel, frequency stated", roles=BOTH[1:]),
    "position_stated": replace(
        ONE_MASS, about="a driven spring, position at stated frequencies", roles=("displacement_x",),
        clearances=(50.0,), frequencies=21, lowest=0.6, highest=1.6,
    ),
    "few": Kind("two records with impacts, six without", select="few"),
    "twelve": Kind("12 records: two gaps, three frequencies", clearances=(0.6, 1.5), lowest=0.8, highest=1.75, frequencies=3),
    "steps_7": Kind("boundaries in steps of 7 % of f0", boundary_step=0.07),
    "steps_3": Kind("boundaries in steps of 3 %", boundary_step=0.03),
    "steps_1": Kind("boundaries in steps of 1 %", boundary_step=0.01),
    "steps_0.3": Kind("boundaries in steps of 0.3 %", boundary_step=0.003),
    # rigs of other sizes
    "slow_rig": Kind("f0 2 to 4 Hz, 5 s at 500 Hz", frequency_hz=(2.0, 4.0), duration_s=5.0, rate_hz=500.0, settle_s=30.0),
    "slow_short": Kind("f0 3 to 5 Hz, records of 1 s", frequency_hz=(3.0, 5.0), settle_s=25.0),
    "fast_rig": Kind("f0 60 to 120 Hz at 10 kHz, x_st 20 to 60 µm", frequency_hz=(60.0, 120.0), rate_hz=1e4, settle_s=2.0, deflection_m=(2e-5, 6e-5)),
    "fast_2k": Kind("f0 60 to 120 Hz at 2 kHz", frequency_hz=(60.0, 120.0), settle_s=2.0, deflection_m=(2e-5, 6e-5)),
    "light": Kind("β 0.004 to 0.01", damping=(0.004, 0.01), settle_s=40.0),
    "heavy": Kind("β 0.12 to 0.2", damping=(0.12, 0.2)),
    "plastic": Kind("R 0.15 to 0.4", restitution=(0.15, 0.4)),
    "elastic": Kind("R 0.93 to 0.98", restitution=(0.93, 0.98)),
}
