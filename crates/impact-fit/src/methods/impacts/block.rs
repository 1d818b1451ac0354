//! R from the speeds after over before each impact.

use crate::evidence::pickup::Pickups;
use crate::parameters::effect::Effect;
use crate::parameters::own::log_speed;
use crate::parameters::{CHANNELS, Coordinate, Parameters, gain_index};
use crate::solver::Block;
use impact_records::event::{
    CornerShift, DetectionSource, Impact, Lag, MassSpeeds, RigKind, extrapolation_error,
};
use impact_records::motion::Observation;
use impact_records::record::Role;

/// The speeds of one mass at an impact, as its channel reads them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnSpeeds {
    /// Index of the channel's gain.
    pub gain: usize,
    /// Toward the other mass before and after the impact, m/s.
    pub toward_m_s: [f64; 2],
}

/// One impact's speeds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpeedPair {
    /// Index of the record among the observations.
    pub observation: usize,
    /// Time since the record's first sample, s.
    pub time_s: f64,
    /// Closing speed before, m/s.
    pub before_m_s: f64,
    /// Parting speed after, m/s (positive).
    pub after_m_s: f64,
    /// Standard errors of the speeds before and after by noise, m/s.
    pub errors_m_s: [f64; 2],
    /// What a standard error of the impact's time changes of the approach speed before and after, m/s.
    pub by_time_m_s: [f64; 2],
    /// The speeds of both masses between which a drive acts; `None` of a mass that is not measured, or flies freely. Where
    /// one mass moves otherwise than the other, gains change the ratio.
    pub of_masses: [Option<OwnSpeeds>; 2],
    /// What the channels' corners would change of the speeds, toward each other.
    pub corner_shifts: [Option<CornerShift>; 2],
    /// What delays of the channels would change of them.
    pub lags: [Option<Lag>; 2],
    /// What the velocities pick up of the drive there per unit of strength of [`PICKUPS`], m/s.
    pub picked_up_m_s: [f64; 2],
    /// Place of the record in the campaign: −½ (first) to ½ (last).
    pub place: f64,
    /// Where between two samples the impact falls, counted from the first one of its record, in sampling
    /// intervals; `None` where the motion does not tell.
    pub sample_place: Option<f64>,
    /// Factor on the standard error, as errors are shared within the record.
    pub in_record: f64,
}

impl SpeedPair {
    /// The first impact of a first record: two speeds with their error, which nothing else changes.
    #[cfg(test)]
    pub(crate) fn of_speeds(before_m_s: f64, after_m_s: f64, error_m_s: f64) -> Self {
        Self {
            observation: 0,
            time_s: 0.0,
            before_m_s,
            after_m_s,
            errors_m_s: [error_m_s; 2],
            by_time_m_s: [0.0; 2],
            of_masses: [None, None],
            corner_shifts: [None, None],
            lags: [None, None],
            picked_up_m_s: [0.0; 2],
            place: 0.0,
            sample_place: None,
            in_record: 1.0,
        }
    }

    /// Standard error of either speed by noise, the greater of both, m/s.
    pub fn error_m_s(&self) -> f64 {
        self.errors_m_s[0].max(self.errors_m_s[1])
    }

    /// Read the speeds with the delays of the channels that waveforms tell.
    fn delay(&mut self, parameters: &Parameters) {
        let lags = self.lags.iter().flatten();
        let kink_s: f64 = lags
            .map(|lag| lag.share * parameters.delay_s(lag.displacement))
            .sum();
        for lag in self.lags.iter_mut().flatten() {
            let delay_s = parameters.delay_s(lag.velocity) - kink_s;
            let later_s = delay_s - std::mem::replace(&mut lag.assumed_s, delay_s);
            self.before_m_s += later_s * lag.accelerations_m_s2[0];
            self.after_m_s -= later_s * lag.accelerations_m_s2[1];
        }
    }

    /// What a standard error of the impact's time changes of R·before − after, m/s: the approach speed
    /// after is minus the speed after.
    fn late(&self, restitution: f64) -> f64 {
        self.by_time_m_s[1] + restitution * self.by_time_m_s[0]
    }

    /// The closing speed before and the parting speed after, m/s, with corners, pick-up and, where they count, gains over those
    /// that the speeds were read by.
    fn read(&self, parameters: &Parameters, read_by: Option<&[f64; CHANNELS]>) -> [f64; 2] {
        let shift = self.shift(parameters);
        let [mut before, mut after] = [self.before_m_s + shift, self.after_m_s - shift];
        for (gains, own) in read_by.into_iter().flat_map(|gains| self.each(gains)) {
            let off = gains / parameters.gains[own.gain] - 1.0;
            before += off * own.toward_m_s[0];
            after -= off * own.toward_m_s[1];
        }
        [before, after]
    }

    /// The speeds of each mass with the gain that they were read by.
    fn each(&self, read_by: &[f64; CHANNELS]) -> impl Iterator<Item = (f64, OwnSpeeds)> {
        let own = self.of_masses.iter().flatten();
        own.map(|own| (read_by[own.gain], *own))
    }

    /// Change of the closing speed, m/s, by corners other than the stated ones.
    fn shift(&self, parameters: &Parameters) -> f64 {
        let shifts = self.corner_shifts.iter().flatten();
        let by_corners: f64 = shifts.map(|s| parameters.corner_shift_m_s(s)).sum();
        let picked_up = PICKUPS.iter().zip(self.picked_up_m_s);
        let picked_up = picked_up.map(|(effect, unit)| parameters.effect(*effect) * unit);
        by_corners - picked_up.sum::<f64>()
    }
}

/// The speeds of both masses at an impact of a driven record; none unless both are measured.
fn of_masses(o: &Observation, impact: &Impact) -> [Option<OwnSpeeds>; 2] {
    let own = |(speeds, of_y): (Option<MassSpeeds>, bool)| {
        let speeds = speeds.filter(|_| o.drive.is_some())?;
        Some(OwnSpeeds {
            gain: gain_index(o.speed_from(of_y)?)?,
            toward_m_s: [speeds.before_m_s, speeds.after_m_s],
        })
    };
    match [(impact.x, false), (impact.y, true)].map(own) {
        [Some(x), Some(y)] => [Some(x), Some(y)],
        _ => [None, None],
    }
}

/// Share of a period by which the impacts of a periodic motion come off it.
const ON_PERIOD: f64 = 0.1;

/// Where between two samples an impact falls, counted from the first one of its record, in sampling intervals, if
/// whole periods of the drive lie between them.
fn sample_place(o: &Observation, time_s: f64) -> Option<f64> {
    let frequency_hz = o.drive?.frequency_hz;
    let periods = (time_s - o.impacts.first()?.time_s) * frequency_hz;
    let whole = periods.round();
    let on_period = (periods - whole).abs() < ON_PERIOD;
    on_period.then(|| (whole * o.sample_rate_hz / frequency_hz).rem_euclid(1.0))
}

/// What the channels of x and of y pick up.
pub const PICKUPS: [Effect; 2] = [Effect::PickupX, Effect::PickupY];

/// What the velocities of an observation pick up of the drive at a time, per unit of strength of [`PICKUPS`], m/s.
fn picked_up_m_s(pickups: &Pickups, o: &Observation, time_s: f64) -> [f64; 2] {
    let Some(drive) = o.drive else {
        return [0.0; 2];
    };
    let drive_now = o.setting.drive_amplitude * drive.phase_at(time_s).cos();
    let of = |(effect, of_y)| match o.speed_from(of_y) {
        Some(role @ (Role::VelocityX | Role::VelocityY)) => pickups.unit(effect, role) * drive_now,
        _ => 0.0,
    };
    [(PICKUPS[0], false), (PICKUPS[1], true)].map(of)
}

/// Greatest error of extrapolated speeds beside the noise with which they tell R, relative.
const EXTRAPOLATED: f64 = 1e-3;

/// Whether a record tells speeds at impacts: a drive period has samples enough for polynomials to follow the flights
/// beside an impact, and the speeds do not rest on clipped spikes or what a low-pass has left of a jump.
pub(super) fn tells_speeds(o: &Observation) -> bool {
    let per_period = o.drive.map(|drive| o.sample_rate_hz / drive.frequency_hz);
    let follows = |per_period| extrapolation_error(per_period, o.jump_samples) < EXTRAPOLATED;
    !o.excluded() && !o.low_pass && per_period.is_none_or(follows) && !o.speeds_lack_spikes()
}

/// Why speeds at impacts give a fit its first R and no more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FirstValueOnly {
    /// Two masses hit each other and only one of them is measured: twice its speed stands for the approach speed,
    /// whose ratio is R as far as the masses are alike alone.
    OneOfTwo,
    /// Displacements were differentiated beside the kinks that impacts make in them.
    Differentiated,
    /// Velocities rang beside the impacts: their flights are known farther from them only.
    Ringing,
    /// Accelerations are clipped at the impacts of most records: those of the others are the softest.
    Clipped,
}

/// Whether the speeds of driven motions come from displacements.
fn differentiated(observations: &[Observation]) -> bool {
    let mut driven = observations
        .iter()
        .filter(|o| !o.excluded() && o.drive.is_some());
    driven.any(|o| {
        let from = [false, true].map(|of_y| o.speed_from(of_y));
        let mut from = from.iter().flatten();
        from.any(|role| matches!(role, Role::DisplacementX | Role::DisplacementY))
    })
}

/// Share of the driven motions with impacts from which velocities that ring are those of all: in the others noise hides
/// it. Of sound velocities none ring.
const RINGING: f64 = 0.1;

/// Share of them from which accelerations are clipped at the impacts of most.
const CLIPPED: f64 = 0.5;

/// Share of the driven motions with impacts that are such.
fn share_of_driven(observations: &[Observation], is_such: impl Fn(&Observation) -> bool) -> f64 {
    let driven = observations
        .iter()
        .filter(|o| !o.excluded() && o.drive.is_some() && !o.impacts.is_empty());
    let all = driven.clone().count().max(1);
    driven.filter(|o| is_such(o)).count() as f64 / all as f64
}

/// On which corners speeds depend, by their index.
pub fn corners_in<'a>(shifts: impl Iterator<Item = &'a Option<CornerShift>>) -> [bool; CHANNELS] {
    let mut corners = [false; CHANNELS];
    for index in shifts.flatten().filter_map(|s| gain_index(s.role)) {
        corners[index] = true;
    }
    corners
}

/// Standard errors from which a closing speed tells R.
const FAST: f64 = 6.0;

/// Standard errors from which the closing speed of an impact tells R: twice as many where a contact lasts several
/// samples and none within it was resolved, as the speeds of slow ones are swayed by where its middle is put.
pub(super) fn fast_from(o: &Observation, impact: &Impact) -> f64 {
    let unresolved = impact.contact_duration_s.is_none() && o.jump_samples > 2;
    if unresolved { 2.0 * FAST } else { FAST }
}

/// All impacts with measured speeds.
#[derive(Debug, Clone)]
pub struct ImpactBlock {
    /// The pairs.
    pub pairs: Vec<SpeedPair>,
    /// Relative error of each ratio beside the noise: what the extrapolation leaves open.
    pub relative_error: f64,
    /// The median approach speed, m/s, at which R is the campaign's; 0 without impacts.
    pub typical_approach_m_s: f64,
    /// The gains over the stated ones by which the speeds were read, where gains count; `None` of masses that move alike: gains
    /// cancel from the ratio of their speeds, and what noise leaves of them would carry the errors of the law of contact into
    /// the gains.
    pub read_by: Option<[f64; CHANNELS]>,
    /// On which corners the speeds depend, by their index.
    corners: [bool; CHANNELS],
    /// Whether the impacts are between free flights, of records without a drive.
    pub free: bool,
    /// Why the speeds give a fit its first R and no more.
    pub first_value_only: Option<FirstValueOnly>,
    /// What springs and drive, not the contact, add to the separation speed in the median of the contacts that
    /// last, over the approach speed, as a spring and a damper have it.
    pub push: f64,
}

/// Root mean square of what other laws of contact make of that push less what a spring and a damper make of it, over
/// the latter: five laws for R of 0.5 to 0.9 (`fit::contact_laws`).
pub(crate) const PUSH_OF_LAWS: f64 = 2.0;

/// Share of the error of an impact between free flights that all have in common.
const COMMON: f64 = 0.4;

/// Impacts between free flights from which outliers are looked for: fewer are all reported.
const ENOUGH_FOR_OUTLIERS: usize = 8;

impl ImpactBlock {
    /// Collect impacts without dead zone, [`fast`] by the standard errors of [`fast_from`].
    pub fn new(rig: RigKind, observations: &[Observation], relative_error: f64) -> Self {
        let pickups = Pickups::of(observations);
        let measured: Vec<(SpeedPair, f64)> = observations
            .iter()
            .enumerate()
            .filter(|(_, o)| tells_speeds(o))
            .flat_map(|(i, o)| o.impacts.iter().map(move |impact| (i, impact)))
            .filter(|(_, impact)| impact.dead_zone_s == 0.0)
            // heights are a method of their own
            .filter(|(_, impact)| impact.source != DetectionSource::Heights)
            .filter_map(|(i, impact)| {
                let pair = SpeedPair {
                    observation: i,
                    time_s: impact.time_s,
                    before_m_s: impact.approach_speed_before_m_s?,
                    after_m_s: -impact.approach_speed_after_m_s?
                        - impact.external_push_m_s.unwrap_or(0.0),
                    errors_m_s: impact.speed_errors_m_s?,
                    by_time_m_s: impact.speeds_by_time_m_s.unwrap_or_default(),
                    of_masses: of_masses(&observations[i], impact),
                    corner_shifts: impact.corner_shifts,
                    lags: impact.lags,
                    picked_up_m_s: picked_up_m_s(&pickups, &observations[i], impact.time_s),
                    place: 0.0,
                    sample_place: sample_place(&observations[i], impact.time_s),
                    in_record: 1.0,
                };
                Some((pair, fast_from(&observations[i], impact)))
            })
            .filter(|(p, _)| p.after_m_s > -4.0 * p.errors_m_s[1])
            .collect();
        let pairs = fast(measured, relative_error);
        let free = pairs
            .iter()
            .all(|p: &SpeedPair| observations[p.observation].drive.is_none());
        let impacts = observations.iter().filter(|o| !o.excluded());
        let sees_both = |i: &Impact| i.x.is_some() && i.y.is_some();
        let mut with_speeds = impacts
            .flat_map(|o| &o.impacts)
            .filter(|i| i.x.is_some() || i.y.is_some());
        Self {
            free,
            first_value_only: if rig == RigKind::Double && with_speeds.any(|i| !sees_both(i)) {
                Some(FirstValueOnly::OneOfTwo)
            } else if differentiated(observations) {
                Some(FirstValueOnly::Differentiated)
            } else if share_of_driven(observations, |o| o.smoothed) > RINGING {
                Some(FirstValueOnly::Ringing)
            } else {
                let clipped = share_of_driven(observations, Observation::speeds_lack_spikes);
                (clipped > CLIPPED).then_some(FirstValueOnly::Clipped)
            },
            push: push(observations),
            ..Self::of_pairs(pairs, relative_error)
        }
    }

    /// Whether speeds at impacts tell R.
    pub fn tells(&self) -> bool {
        !self.pairs.is_empty() && self.first_value_only.is_none()
    }

    /// The typical ratio of the speed after to that before.
    pub fn typical_ratio(&self) -> Option<f64> {
        let ratios: Vec<f64> = self
            .pairs
            .iter()
            .map(|p| p.after_m_s / p.before_m_s)
            .collect();
        impact_records::signal::robust::median(&ratios)
    }

    /// What the unknown law of contact leaves open in R.
    pub fn open_by_law(&self) -> f64 {
        PUSH_OF_LAWS * self.push
    }

    /// What all impacts between free flights have in common of their errors: how their contacts are timed.
    pub fn common_error(&self) -> f64 {
        if !self.free {
            return 0.0;
        }
        let error = |p: &SpeedPair| self.error(p, p.after_m_s / p.before_m_s) / p.before_m_s;
        let errors: Vec<f64> = self.pairs.iter().map(error).collect();
        COMMON * impact_records::signal::robust::median(&errors).unwrap_or(0.0)
    }

    /// Fewest impacts that a fit needs: one between free flights has a ratio of its own.
    pub fn fewest(&self) -> usize {
        if self.free { 1 } else { 3 }
    }

    /// Of given pairs.
    pub fn of_pairs(pairs: Vec<SpeedPair>, relative_error: f64) -> Self {
        let corners = corners_in(pairs.iter().flat_map(|p| &p.corner_shifts));
        let speeds: Vec<f64> = pairs.iter().map(|p| p.before_m_s).collect();
        Self {
            typical_approach_m_s: impact_records::signal::robust::median(&speeds).unwrap_or(0.0),
            pairs,
            relative_error,
            read_by: None,
            corners,
            free: false,
            first_value_only: None,
            push: 0.0,
        }
    }

    /// Whether an effect is what the speeds pick up of the drive.
    fn picks_up(&self, effect: Effect) -> bool {
        let place = PICKUPS.iter().position(|p| *p == effect);
        let picked_up = |i| self.pairs.iter().any(|p| p.picked_up_m_s[i] != 0.0);
        place.is_some_and(picked_up)
    }

    /// Whether some speeds depend on a channel's corner.
    pub fn has_corner(&self, index: usize) -> bool {
        self.corners[index]
    }

    /// Leave out pairs that do not lie within `limit` robust deviations of the bulk, and give them.
    pub fn extract_outliers(&mut self, limit: f64) -> Vec<SpeedPair> {
        let Some(centre) = self.typical_ratio() else {
            return Vec::new();
        };
        if self.free && self.pairs.len() < ENOUGH_FOR_OUTLIERS {
            return Vec::new();
        }
        let scores: Vec<f64> = self
            .pairs
            .iter()
            .map(|p| (p.after_m_s - centre * p.before_m_s) / self.error(p, centre))
            .collect();
        let spread = impact_records::signal::robust::robust_deviation(&scores)
            .unwrap_or(1.0)
            .max(0.5);
        let mut is_odd = scores.iter().map(|s| !(s.abs() <= limit * spread));
        let odd = self.pairs.extract_if(.., |_| is_odd.next() == Some(true));
        odd.collect()
    }

    /// Take pairs in, and read all with the delays of the channels that waveforms tell.
    pub fn delay(&mut self, others: Vec<SpeedPair>, parameters: &Parameters) {
        self.pairs.extend(others);
        for pair in &mut self.pairs {
            pair.delay(parameters);
            pair.in_record = 1.0;
        }
        self.pairs.sort_by(|a, b| {
            let by_time = a.time_s.total_cmp(&b.time_s);
            a.observation.cmp(&b.observation).then(by_time)
        });
    }

    /// Whether delays of the channels change any speed.
    pub fn has_lags(&self) -> bool {
        let mut lags = self.pairs.iter().flat_map(|p| p.lags);
        lags.any(|lag| lag.is_some())
    }

    /// The speeds as they are with the corners and gains that a fit found.
    #[must_use]
    pub fn corrected(&self, parameters: &Parameters) -> Self {
        let mut block = Self {
            read_by: None,
            ..self.clone()
        };
        for pair in &mut block.pairs {
            [pair.before_m_s, pair.after_m_s] = pair.read(parameters, self.read_by.as_ref());
            pair.corner_shifts = [None, None];
            pair.picked_up_m_s = [0.0; 2];
        }
        block
    }

    /// Standard error of after − R·before.
    pub fn error(&self, pair: &SpeedPair, restitution: f64) -> f64 {
        pair.in_record * self.own_error(pair, restitution)
    }

    /// The same of an impact alone, whatever it shares with others of its record.
    fn own_error(&self, pair: &SpeedPair, restitution: f64) -> f64 {
        let [before, after] = pair.errors_m_s;
        after
            .hypot(restitution * before)
            .hypot(pair.late(restitution))
            .hypot(self.relative_error * pair.before_m_s)
    }

    /// The true closing speed by both speeds, m/s: its error and their deviation from R are independent.
    pub fn closing_speed(&self, pair: &SpeedPair, restitution: f64) -> f64 {
        let deviation = pair.after_m_s - restitution * pair.before_m_s;
        pair.before_m_s + self.shared(pair, restitution) * deviation
    }

    /// The closing speed times its logarithm over the typical one, m/s.
    fn speed_log(&self, pair: &SpeedPair, restitution: f64) -> f64 {
        let speed = self.closing_speed(pair, restitution);
        speed * log_speed(speed, self.typical_approach_m_s)
    }

    /// Mean error of the speed before per error of after − R·before, with the sign of −1: half the slope
    /// of the variance of that over R, over the variance.
    fn shared(&self, pair: &SpeedPair, restitution: f64) -> f64 {
        let noise = restitution * pair.errors_m_s[0].powi(2);
        let time = pair.by_time_m_s[0] * pair.late(restitution);
        (noise + time) / self.own_error(pair, restitution).powi(2)
    }
}

/// The pairs whose closing speed is so many standard errors of theirs. It is that by both speeds, which does not depend
/// on their deviation from one ratio: by the speed before alone those whose error makes it fast would be kept, and
/// the ratio of slow impacts would be too low.
fn fast(measured: Vec<(SpeedPair, f64)>, relative_error: f64) -> Vec<SpeedPair> {
    let by_one = measured
        .iter()
        .filter(|(pair, least)| pair.before_m_s > least * pair.error_m_s());
    let by_one = ImpactBlock::of_pairs(by_one.map(|(pair, _)| *pair).collect(), relative_error);
    let Some(ratio) = by_one.typical_ratio() else {
        return Vec::new();
    };
    let is_fast = |(pair, least): &(SpeedPair, f64)| {
        by_one.closing_speed(pair, ratio) > least * pair.error_m_s()
    };
    let fast = measured.into_iter().filter(is_fast);
    let mut pairs: Vec<SpeedPair> = fast.map(|(pair, _)| pair).collect();
    // of very many, collecting leaves room for as many more
    pairs.shrink_to_fit();
    pairs
}

/// Median of |push| over the approach speed, of the contacts that last.
fn push(observations: &[Observation]) -> f64 {
    let impacts = observations.iter().flat_map(|o| &o.impacts);
    let pushed = impacts.filter_map(|i| {
        let before = i.approach_speed_before_m_s.filter(|v| *v > 0.0)?;
        Some((i.external_push_m_s? / before).abs())
    });
    impact_records::signal::robust::median(&pushed.collect::<Vec<f64>>()).unwrap_or(0.0)
}

impl Block for ImpactBlock {
    fn items(&self) -> usize {
        self.pairs.len()
    }

    fn owners(&self) -> Vec<usize> {
        self.pairs.iter().map(|item| item.observation).collect()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let pair = &self.pairs[item];
        let r = parameters.restitution;
        let [before, after] = pair.read(parameters, self.read_by.as_ref());
        let over_speed = parameters.effect(Effect::RestitutionSpeed) * self.speed_log(pair, r);
        let in_time = parameters.effect(Effect::RestitutionDrift) * pair.place * before;
        Some(vec![
            (after - r * before - over_speed - in_time) / self.error(pair, r),
        ])
    }

    fn slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let pair = &self.pairs[item];
        let r = parameters.restitution;
        let residuals = self.residuals(item, parameters)?;
        let error = self.error(pair, r);
        let [before, _] = pair.read(parameters, self.read_by.as_ref());
        let slope = |coordinate: &Coordinate| match coordinate {
            Coordinate::Gain(index) => {
                let each = self.read_by.iter().flat_map(|gains| pair.each(gains));
                let of_gain = each.filter(|(_, own)| own.gain == *index);
                let left =
                    of_gain.map(|(gain, own)| gain * (own.toward_m_s[1] + r * own.toward_m_s[0]));
                left.sum::<f64>() / parameters.gains[*index] / error
            }
            Coordinate::Restitution => -before / error - residuals[0] * self.shared(pair, r),
            Coordinate::Corner(index) => {
                let shifts = pair.corner_shifts.iter().flatten();
                let own = shifts.filter(|s| gain_index(s.role) == Some(*index));
                -(1.0 + r) * own.map(|s| s.speed_m_s).sum::<f64>() / error
            }
            Coordinate::Effect(Effect::RestitutionSpeed) => -self.speed_log(pair, r) / error,
            Coordinate::Effect(Effect::RestitutionDrift) => -pair.place * before / error,
            Coordinate::Effect(effect) => {
                let place = PICKUPS.iter().position(|p| p == effect);
                (1.0 + r) * place.map_or(0.0, |i| pair.picked_up_m_s[i]) / error
            }
            _ => 0.0,
        };
        let columns = coordinates.iter().map(|c| vec![slope(c)]).collect();
        Some((residuals, columns))
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        match coordinate {
            Coordinate::Corner(index) => self.has_corner(index),
            Coordinate::Gain(index) => {
                let mut own = self.pairs.iter().flat_map(|p| p.of_masses).flatten();
                self.read_by.is_some() && own.any(|own| own.gain == index)
            }
            Coordinate::Effect(Effect::RestitutionSpeed | Effect::RestitutionDrift) => !self.free,
            Coordinate::Effect(effect) => self.picks_up(effect),
            _ => coordinate == Coordinate::Restitution,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::impacts::contact_law::contact_law;
    use crate::solver::block::difference;
    use impact_records::record::Role;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn lag(velocity: Role, displacement: Role, accelerations_m_s2: [f64; 2]) -> Option<Lag> {
        Some(Lag {
            velocity,
            displacement,
            share: 0.5,
            assumed_s: 1e-4,
            accelerations_m_s2,
        })
    }

    /// Pairs of R = 0.7 at speeds up to twelve errors, of which either speed may be the one that is known less well.
    fn slow(seed: u64) -> Vec<SpeedPair> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let pair = |i: u32| {
            let speed = 0.12 * f64::from(i % 397) / 397.0;
            let errors_m_s = [[0.01, 0.01], [0.003, 0.01], [0.01, 0.003]][i as usize % 3];
            let before_m_s = speed + errors_m_s[0] * normal();
            let after_m_s = 0.7 * speed + errors_m_s[1] * normal();
            SpeedPair {
                observation: i as usize,
                errors_m_s,
                ..SpeedPair::of_speeds(before_m_s, after_m_s, 0.0)
            }
        };
        (0..3000).map(pair).collect()
    }

    #[test]
    fn valid_slow_impacts_that_noise_makes_fast_do_not_lower_the_ratio() {
        for seed in 0..20 {
            let measured = slow(seed).into_iter().map(|pair| (pair, FAST)).collect();
            let block = ImpactBlock::of_pairs(fast(measured, 1e-3), 1e-3);
            assert!(block.pairs.len() > 1000, "{}", block.pairs.len());
            let law = contact_law(&block).expect("a law");
            assert!(!law.is_not_constant(), "{:?}", law.curve);
            for point in &law.curve {
                let apart = point.restitution - 0.7;
                assert!(apart.abs() < 4.0 * point.standard_error, "{point:?}");
            }
        }
    }

    #[test]
    fn valid_slopes_are_those_of_finite_differences() {
        let shift = |role, speed_m_s| Some(CornerShift { role, speed_m_s });
        let own = |gain, toward_m_s| Some(OwnSpeeds { gain, toward_m_s });
        let pair = SpeedPair {
            by_time_m_s: [4e-3, 1e-3],
            of_masses: [own(0, [0.1, -0.3]), own(1, [0.4, -0.07])],
            corner_shifts: [shift(Role::VelocityX, 3e-3), shift(Role::VelocityY, -2e-3)],
            picked_up_m_s: [0.3, -0.1],
            place: 0.3,
            ..SpeedPair::of_speeds(0.5, 0.37, 5e-3)
        };
        let mut block = ImpactBlock::of_pairs(vec![pair], 4e-3);
        let mut parameters = Parameters::symmetric(0.8, 10.0, 0.05, 1e-3);
        parameters.corners = [1.1, 0.9, 1.0, 1.0, 1.0, 1.0];
        parameters.gains = [1.02, 0.97, 1.0, 1.0, 1.0, 1.0];
        let parameters = parameters.with(Coordinate::Effect(Effect::PickupX), 2e-3);
        block.typical_approach_m_s = 0.3;
        block.read_by = Some([1.0; CHANNELS]);
        let coordinates = [
            Coordinate::Effect(Effect::RestitutionSpeed),
            Coordinate::Effect(Effect::RestitutionDrift),
            Coordinate::Restitution,
            Coordinate::Corner(0),
            Coordinate::Corner(1),
            Coordinate::Gain(0),
            Coordinate::Gain(1),
            Coordinate::Effect(Effect::PickupX),
            Coordinate::Effect(Effect::PickupY),
        ];
        let (here, columns) = block.slopes(0, &parameters, &coordinates).expect("slopes");
        for (coordinate, exact) in coordinates.iter().zip(columns) {
            let found = difference(&parameters, *coordinate, &here, |p| block.residuals(0, p));
            let apart = found.expect("differences")[0] - exact[0];
            assert!(
                apart.abs() < 1e-7 * exact[0].abs(),
                "{coordinate:?}: {apart}"
            );
        }
    }

    #[test]
    fn valid_gains_move_the_ratio_only_where_one_mass_moves_otherwise() {
        // closing at 0.5 m/s, parting at 0.4 m/s, x by half of it and y by the rest, or y running away at 1 m/s beside
        let ratio = |away: f64| {
            let of = |gain: usize, toward: [f64; 2]| {
                Some(OwnSpeeds {
                    gain,
                    toward_m_s: toward,
                })
            };
            let pair = SpeedPair {
                of_masses: [
                    of(0, [0.25 + away, -0.2 + away]),
                    of(1, [0.25 - away, -0.2 - away]),
                ],
                ..SpeedPair::of_speeds(0.5, 0.4, 1e-3)
            };
            let mut parameters = Parameters::symmetric(0.8, 10.0, 0.05, 1e-3);
            parameters.gains[0] = 1.01;
            let [before, after] = pair.read(&parameters, Some(&[1.0; CHANNELS]));
            after / before
        };
        assert!((ratio(0.0) - 0.8).abs() < 1e-12);
        let off = 1.0 / 1.01 - 1.0;
        let expected = (0.4 - off * (-0.2 + 1.0)) / (0.5 + off * (0.25 + 1.0));
        assert!((ratio(1.0) - expected).abs() < 1e-12);
        assert!((ratio(1.0) - 0.8).abs() > 0.02);
    }

    #[test]
    fn valid_impacts_whose_r_follows_the_speed_fit_with_its_slope() {
        // R = 0.8 − 0.02 ln v/v₀: to second order of the slope the residuals vanish
        let restitution = |v: f64| 0.8 - 0.02 * (v / 0.4).ln();
        let pair = |v: f64| SpeedPair::of_speeds(v, restitution(v) * v, 1e-3);
        let block = ImpactBlock::of_pairs([0.2, 0.4, 0.7].map(pair).into(), 0.0);
        assert!((block.typical_approach_m_s - 0.4).abs() < 1e-12);
        let constant = Parameters::symmetric(0.8, 10.0, 0.05, 1e-3);
        let slope = constant.with(Coordinate::Effect(Effect::RestitutionSpeed), -0.02);
        for (item, v) in [0.2, 0.4, 0.7].into_iter().enumerate() {
            let off = |p: &Parameters| block.residuals(item, p).expect("a residual")[0];
            let unexplained = off(&constant).abs();
            assert!(
                off(&slope).abs() < 0.02 * unexplained + 1e-9,
                "{v}: {unexplained}"
            );
        }
    }

    #[test]
    fn valid_speeds_are_read_where_the_delays_of_the_channels_place_them() {
        let pair = SpeedPair {
            lags: [
                lag(Role::VelocityX, Role::DisplacementX, [10.0, 4.0]),
                lag(Role::VelocityY, Role::DisplacementY, [20.0, 8.0]),
            ],
            ..SpeedPair::of_speeds(0.5, 0.4, 1e-3)
        };
        let mut parameters = Parameters::symmetric(0.8, 10.0, 0.05, 1e-3);
        parameters.delays_s = [5e-4, 2e-4, 1e-4, 3e-4, 0.0, 0.0];
        // the kink is 0.2 ms late: x is read 0.3 − 0.1 ms later, y 0 − 0.1 ms
        let delayed = |pair: SpeedPair, parameters: &Parameters| {
            let mut block = ImpactBlock::of_pairs(vec![pair], 0.0);
            block.delay(Vec::new(), parameters);
            block.pairs[0]
        };
        let found = delayed(pair, &parameters);
        assert!((found.before_m_s - (0.5 + 2e-4 * 10.0 - 1e-4 * 20.0)).abs() < 1e-12);
        assert!((found.after_m_s - (0.4 - 2e-4 * 4.0 + 1e-4 * 8.0)).abs() < 1e-12);
        // read once more with the same delays, nothing changes; without delays, all comes back
        assert_eq!(delayed(found, &parameters), found);
        parameters.delays_s = [1e-4, 1e-4, 0.0, 0.0, 0.0, 0.0];
        let back = delayed(found, &parameters);
        assert!((back.before_m_s - 0.5).abs() < 1e-12 && (back.after_m_s - 0.4).abs() < 1e-12);
    }
}
