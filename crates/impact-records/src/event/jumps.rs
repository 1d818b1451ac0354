//! Jumps of the approach velocity: instants at which one-sided extrapolations from left and right
//! disagree.

use std::f64::consts::SQRT_2;

use crate::event::kinematics::Series;
use crate::signal::columns;
use crate::signal::local_fit::LocalFit;
use crate::signal::robust;
use crate::signal::whole;

/// Significance (in standard errors) above which a jump counts by itself.
const SIGNIFICANT: f64 = 6.0;

/// Significance that suffices where the contact channel shows a pulse, or the masses touch.
const SUPPORTED: f64 = 3.0;

/// Significance that suffices where most motions show a jump at the same place.
const RECURRING: f64 = 1.0;

/// Motions of which most must show a weak jump.
const FEWEST_MOTIONS: usize = 5;

/// Share of the motions that must show it: more than show one of every second period. Noise shows one at less than a
/// hundredth of all places.
const MOST: f64 = 0.6;

/// A jump of velocity between two samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Jump {
    /// Last sample before the jump; the velocity is on the other branch `gap` samples later.
    pub left: usize,
    /// Samples from the last one before to the first one after the jump; 1 when instantaneous.
    pub gap: usize,
    /// Velocity after minus before, both extrapolated to the middle of the gap.
    pub height: f64,
    /// Standard error of the height.
    pub error: f64,
}

impl Jump {
    /// Middle of the gap, in samples.
    pub(super) fn middle(&self) -> f64 {
        self.left as f64 + 0.5 * self.gap as f64
    }

    /// By how much the velocity's samples beside the jump fall; `None` beyond the record.
    pub(super) fn fall(&self, values: &[f64]) -> Option<f64> {
        Some(values.get(self.left)? - values.get(self.left + self.gap)?)
    }

    /// Height over its standard error, positive for a jump down as impacts make it.
    pub(super) fn significance(&self) -> f64 {
        -self.height / self.error
    }
}

/// Jumps that were found in the same velocity before it was smoothed, and for how long it rang beside these.
#[derive(Debug, Clone)]
pub(super) struct KnownJumps {
    /// Where they are, samples.
    pub places: Vec<f64>,
    /// Samples from a jump in which another one may have been its ringing.
    pub rang: f64,
}

/// Jump that is to be significant despite the noise, over the amplitude of the velocity.
const WEAK: f64 = 0.1;

/// Samples of one-sided windows in which jumps show: as many as given, or so many more, up to a limit, that weak ones are
/// significant or that noise makes no greater error of a jump than what parabolas miss of a harmonic motion with so
/// many samples a period.
pub(super) fn window(velocity: &Series, per_period: f64, least: usize, most: usize) -> usize {
    let noise = velocity.noise;
    let squares = robust::rms_about_mean(&velocity.values).powi(2) - noise * noise;
    let amplitude = (2.0 * squares.max(0.0)).sqrt();
    let turn = std::f64::consts::TAU / per_period;
    let ahead = 0.5 * velocity.least_gap() as f64;
    let bends = |weights: &[f64]| {
        let places = || (0..weights.len()).map(|i| turn * (i as f64 + ahead));
        let sum =
            |of: fn(f64) -> f64| -> f64 { places().zip(weights).map(|(at, w)| w * of(at)).sum() };
        amplitude * (sum(f64::cos) - 1.0).hypot(sum(f64::sin))
    };
    let enough = |count: &usize| {
        let weights = one_sided_weights(*count, ahead);
        let error = SQRT_2 * velocity.error_of_sum(&weights);
        error <= (WEAK / SIGNIFICANT * amplitude).max(SQRT_2 * bends(&weights))
    };
    let wider = (0..).map(|k| least + k * least.div_ceil(4));
    let mut wider = wider.take_while(|count| *count < most);
    wider.find(enough).unwrap_or(most.max(least))
}

/// A search for jumps in one velocity signal.
#[derive(Debug, Clone)]
pub(super) struct JumpSearch<'a> {
    velocity: &'a Series,
    /// Samples of each one-sided window.
    window: usize,
    /// Samples a jump takes from one branch to the other; 1 when instantaneous.
    pub gap: usize,
    scan: Vec<f64>,
    scan_deviation: f64,
    /// Standard error of a jump between full windows by noise.
    full_error: f64,
}

impl<'a> JumpSearch<'a> {
    /// Scan a velocity with one-sided windows of `window` samples (at least 4).
    ///
    /// The samples that a jump takes (its gap) are estimated from the strongest jumps.
    pub(super) fn new(velocity: &'a Series, window: usize) -> Self {
        let least = velocity.least_gap();
        let mut search = Self::with_gap(velocity, window.max(4), least);
        let wanted = search.typical_gap();
        if wanted > least {
            search = Self::with_gap(velocity, window.max(4), wanted);
        }
        search
    }

    fn with_gap(velocity: &'a Series, window: usize, gap: usize) -> Self {
        let weights = one_sided_weights(window, 0.5 * gap as f64);
        let values = &velocity.values;
        let count = values.len();
        let mut scan = vec![0.0; count];
        let first = window.saturating_sub(1);
        let last = count.saturating_sub(gap + window - 1).max(first);
        for (j, weight) in weights.iter().enumerate() {
            let heights = scan.get_mut(first..last).unwrap_or_default();
            let after = values.get(first + gap + j..).unwrap_or_default();
            let before = values.get(first - j..).unwrap_or_default();
            columns::add_difference(heights, *weight, [after, before]);
        }
        let full_error = SQRT_2 * velocity.error_of_sum(&weights);
        let observed = quiet_deviation(&scan);
        Self {
            velocity,
            window,
            gap,
            scan_deviation: observed.max(full_error),
            scan,
            full_error,
        }
    }

    /// Samples that the strongest jumps take from branch to branch (upper quartile of up to
    /// ten).
    fn typical_gap(&self) -> usize {
        let strongest = self.candidates(SIGNIFICANT, -1.0);
        let mut gaps: Vec<f64> = strongest
            .iter()
            .take(10)
            .filter_map(|&left| self.transition_samples(left))
            .map(|n| n as f64)
            .collect();
        gaps.sort_by(f64::total_cmp);
        // A contact that lasts about as long as a step takes one step or two, by where it falls.
        gaps.get(gaps.len() * 3 / 4)
            .map_or(1, |g| whole::index(*g).clamp(1, self.window))
    }

    /// Samples of the steep stretch around a jump: steps that exceed the flight's own slope beside
    /// it by more than noise and a twentieth of the jump.
    fn transition_samples(&self, left: usize) -> Option<usize> {
        let values = &self.velocity.values;
        let height = self.scan[left].abs();
        let slope = self.slope_beside(left);
        let steep = |i: usize| {
            let step = values.get(i)? - values.get(i + 1)? - slope;
            Some(step > (0.05 * height).max(4.0 * self.velocity.noise))
        };
        let centre = (left.saturating_sub(1)..=left + 1).find(|&i| steep(i) == Some(true))?;
        let mut first = centre;
        while first > 0 && steep(first - 1) == Some(true) {
            first -= 1;
        }
        let mut last = centre;
        while steep(last + 1) == Some(true) {
            last += 1;
        }
        Some(last - first + 1)
    }

    /// Fall per sample of the flight on the steeper side of a jump, never less than zero.
    fn slope_beside(&self, left: usize) -> f64 {
        let values = &self.velocity.values;
        let fall = |first: usize, end: usize| {
            let side = values.get(first..end.min(values.len()))?;
            let steps: Vec<f64> = side.windows(2).map(|w| w[0] - w[1]).collect();
            robust::median(&steps)
        };
        let before = fall(left.saturating_sub(self.window), left);
        let after = fall(left + self.gap + 1, left + self.gap + 1 + self.window);
        before.into_iter().chain(after).fold(0.0, f64::max)
    }

    /// Local extrema of the scan, strongest first; `sign` −1 for downward jumps, +1 for upward.
    fn candidates(&self, significance: f64, sign: f64) -> Vec<usize> {
        let limit = significance * self.scan_deviation;
        let strength = |i: usize| sign * self.scan[i];
        let mut found: Vec<usize> = (1..self.scan.len().saturating_sub(1))
            .filter(|&i| {
                strength(i) > limit
                    && strength(i) >= strength(i - 1)
                    && strength(i) > strength(i + 1)
            })
            .collect();
        found.sort_by(|&a, &b| strength(b).total_cmp(&strength(a)).then(a.cmp(&b)));
        found
    }

    /// All significant downward jumps, in order of time.
    pub(super) fn find(&self) -> Vec<Jump> {
        let mut accepted: Vec<Jump> = Vec::new();
        for left in self.candidates(SIGNIFICANT, -1.0) {
            if let Some(jump) = self.measure(left, &accepted, SIGNIFICANT) {
                let place = accepted.partition_point(|j| j.left < jump.left);
                accepted.insert(place, jump);
            }
        }
        self.remeasured(accepted)
    }

    /// Add the jumps that are too weak to count alone and come again at the same place of most motions of one to
    /// four drive periods, as no noise does. Only of differences of a displacement: what recurs in a measured velocity
    /// may be its ringing.
    pub(super) fn admit_recurring(&self, per_period: Option<f64>, accepted: &mut Vec<Jump>) {
        let Some(per_period) = per_period.filter(|_| self.velocity.is_differentiated()) else {
            return;
        };
        let weak = self.candidates(SUPPORTED, -1.0);
        while let Some(series) = self.recurring(&weak, per_period, accepted) {
            let found = accepted.len();
            for at in series {
                let first = whole::index((at - self.gap as f64).round());
                if self.is_free(at, accepted) {
                    self.admit_as((first, first + 2 * self.gap), accepted, RECURRING);
                }
            }
            if accepted.len() == found {
                break;
            }
        }
    }

    /// The places of a jump, of those given the strongest one, that comes again and is none of those accepted.
    fn recurring(&self, weak: &[usize], per_period: f64, accepted: &[Jump]) -> Option<Vec<f64>> {
        let shows = |left: &usize| {
            let free = self.is_free(*left as f64, accepted);
            free && self.measure(*left, accepted, SUPPORTED).is_some()
        };
        let shown: Vec<usize> = weak.iter().copied().filter(shows).collect();
        let mut places = shown.clone();
        places.sort_unstable();
        let mut motions = (1..=4).map(|n| f64::from(n) * per_period);
        motions.find_map(|samples| {
            let mut series = shown.iter().map(|left| self.every(*left, samples));
            series.find(|series| self.recurs(&places, series))
        })
    }

    /// Whether a place is so far from all accepted jumps that it shares less than half a window with them.
    fn is_free(&self, at: f64, accepted: &[Jump]) -> bool {
        let apart = 0.5 * self.window as f64;
        accepted.iter().all(|j| (j.left as f64 - at).abs() >= apart)
    }

    fn beside(&self, left: usize, at: f64) -> bool {
        (left as f64 - at).abs() <= self.gap as f64
    }

    /// The places at which a jump is if it comes again every so many samples.
    fn every(&self, left: usize, samples: f64) -> Vec<f64> {
        let inner = self.window as f64..self.scan.len() as f64 - self.window as f64;
        let first = left as f64 - ((left as f64 - inner.start) / samples).floor() * samples;
        let places = (0..).map(|k| first + f64::from(k) * samples);
        places.take_while(|at| *at < inner.end).collect()
    }

    /// Whether most of a series of places are among those given in order.
    fn recurs(&self, places: &[usize], series: &[f64]) -> bool {
        let shows = |at: &&f64| {
            let first = places.partition_point(|p| (*p as f64) < **at - self.gap as f64);
            places.get(first).is_some_and(|p| self.beside(*p, **at))
        };
        let shown = series.iter().filter(shows).count() as f64;
        series.len() >= FEWEST_MOTIONS && shown >= MOST * series.len() as f64
    }

    /// Only the jumps at known places, with weaker ones where none was found.
    pub(super) fn keep_known(&self, jumps: &mut Vec<Jump>, known: &KnownJumps) {
        let gap = self.gap as f64 + 1.0;
        let beside = |jump: &Jump, at: f64, reach: f64| (jump.middle() - at).abs() <= reach;
        jumps.retain(|jump| known.places.iter().any(|at| beside(jump, *at, gap)));
        for at in &known.places {
            let may_be_ringing = |jump: &Jump| beside(jump, *at, gap.max(known.rang));
            if !jumps.iter().any(may_be_ringing) {
                let first = whole::index((at - self.gap as f64).floor());
                self.admit((first, first + self.gap), jumps);
            }
        }
    }

    /// Numbers of significant jumps upward and downward. Of neighbours only the strongest counts,
    /// because the scan swings back beside a jump. The steepest step tells the direction: where a contact
    /// takes longer than a window, its ends seem to jump back.
    pub(super) fn directions(&self) -> (usize, usize) {
        let mut all = self.candidates(SIGNIFICANT, 1.0);
        all.extend(self.candidates(SIGNIFICANT, -1.0));
        all.sort_by(|&a, &b| {
            self.scan[b]
                .abs()
                .total_cmp(&self.scan[a].abs())
                .then(a.cmp(&b))
        });
        let mut kept: Vec<usize> = Vec::new();
        for i in all {
            if kept
                .iter()
                .all(|k| k.abs_diff(i) > 2 * self.window + self.gap)
            {
                kept.push(i);
            }
        }
        let upward = kept.iter().filter(|i| self.steepest_step(**i) > 0.0);
        let upward = upward.count();
        (upward, kept.len() - upward)
    }

    /// The greatest change between neighbouring samples of the windows beside a place.
    fn steepest_step(&self, left: usize) -> f64 {
        let values = &self.velocity.values;
        let last = (left + self.gap + self.window).min(values.len() - 1);
        let beside = &values[left.saturating_sub(self.window)..=last];
        let steps = beside.windows(2).map(|pair| pair[1] - pair[0]);
        let steepest = steps.max_by(|a, b| a.abs().total_cmp(&b.abs()));
        steepest.unwrap_or(0.0)
    }

    /// Add the jump whose left sample is in `first..=last` to the accepted ones, if there is a supported one.
    pub(super) fn admit(&self, range: (usize, usize), accepted: &mut Vec<Jump>) -> bool {
        self.admit_as(range, accepted, SUPPORTED)
    }

    fn admit_as(
        &self,
        (first, last): (usize, usize),
        accepted: &mut Vec<Jump>,
        significance: f64,
    ) -> bool {
        let found = self.near(first, last, accepted, significance);
        if let Some(jump) = found {
            let place = accepted.partition_point(|j| j.left < jump.left);
            accepted.insert(place, jump);
        }
        found.is_some()
    }

    /// The most significant jump whose left sample is in `first..=last` and whose significance
    /// exceeds `significance`, with windows that end before the accepted jumps.
    fn near(
        &self,
        first: usize,
        last: usize,
        accepted: &[Jump],
        significance: f64,
    ) -> Option<Jump> {
        (first..=last)
            .filter_map(|left| self.measure(left, accepted, significance))
            .max_by(|a, b| a.significance().total_cmp(&b.significance()))
    }

    /// Measure a jump with windows that end before the accepted jumps.
    fn measure(&self, left: usize, accepted: &[Jump], significance: f64) -> Option<Jump> {
        let after = accepted.partition_point(|j| j.left < left);
        let low = match after.checked_sub(1).map(|i| &accepted[i]) {
            Some(j) => j.left + j.gap,
            None => 0,
        };
        let high = accepted
            .get(after)
            .map_or(self.velocity.values.len(), |j| j.left + 1);
        // At least two samples between impacts distinguish a jump from a slope; at the record's
        // edges, which no impact bounds, at least five.
        let end = self.velocity.values.len();
        let before = if low == 0 { 5 } else { 2 };
        let behind = if high == end { 5 } else { 2 };
        let best = (left.saturating_sub(1)..=left + 1)
            .filter(|&k| k + 1 >= low + before && k + self.gap + behind <= high)
            .filter_map(|k| self.measure_between(k, low, high))
            .min_by(|a, b| a.1.total_cmp(&b.1))?
            .0;
        (best.significance() > significance).then_some(best)
    }

    fn measure_between(&self, left: usize, low: usize, high: usize) -> Option<(Jump, f64)> {
        let values = &self.velocity.values;
        let first = low.max((left + 1).saturating_sub(self.window));
        let begin = left + self.gap;
        let last = high.min(begin + self.window);
        let before = LocalFit::new(values, first, left + 1, 2)?;
        let after = LocalFit::new(values, begin, last, 2)?;
        let middle = left as f64 + 0.5 * self.gap as f64;
        let factor = before
            .error_factor(middle)
            .hypot(after.error_factor(middle));
        let full = before.samples == self.window && after.samples == self.window;
        // What parabolas miss of the flights themselves is in the scan; shorter windows miss no more.
        let noise = if full {
            self.full_error
        } else {
            1.5 * self.velocity.noise * factor
        };
        let error = noise.max(self.scan_deviation);
        let jump = Jump {
            left,
            gap: self.gap,
            height: after.value(middle) - before.value(middle),
            error: error.max(f64::MIN_POSITIVE),
        };
        Some((jump, before.residual_squares + after.residual_squares))
    }

    /// Measure each accepted jump again with its neighbours known; drop those that are no longer
    /// significant.
    fn remeasured(&self, accepted: Vec<Jump>) -> Vec<Jump> {
        (0..accepted.len())
            .filter_map(|i| {
                let others: Vec<Jump> = accepted
                    .iter()
                    .enumerate()
                    .filter(|(k, _)| *k != i)
                    .map(|(_, j)| *j)
                    .collect();
                self.measure(accepted[i].left, &others, 0.8 * SIGNIFICANT)
            })
            .collect()
    }
}

/// Standard deviation of the scan away from jumps, from the quarter of its values nearest to zero:
/// impacts may follow each other so closely that they affect half of the scan.
fn quiet_deviation(scan: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = scan.iter().map(|v| v.abs()).filter(|v| *v > 0.0).collect();
    let quarter = sizes.len() / 4;
    if sizes.is_empty() {
        return 0.0;
    }
    // A quarter of a normal distribution is within 0.3186 deviations of its centre.
    *sizes.select_nth_unstable_by(quarter, f64::total_cmp).1 / 0.3186
}

/// Weights that extrapolate a parabola from `count` samples by `ahead` steps beyond the first of
/// them (index 0 is the nearest sample).
fn one_sided_weights(count: usize, ahead: f64) -> Vec<f64> {
    (0..count)
        .map(|i| {
            let mut unit = vec![0.0; count];
            unit[i] = 1.0;
            LocalFit::new(&unit, 0, count, 2).map_or(0.0, |fit| fit.value(-ahead))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, Normal};

    /// A line of slope 0.01 per sample that steps by `height` after sample 50, over `gap` samples.
    fn stepped(height: f64, gap: usize) -> Series {
        let share = |i: usize| (i.saturating_sub(50) as f64 / gap as f64).min(1.0);
        Series::clean(
            (0..120)
                .map(|i| 0.01 * i as f64 + height * share(i))
                .collect(),
        )
    }

    #[test]
    fn valid_a_step_between_two_lines_is_found_with_its_height() {
        let velocity = stepped(-0.8, 1);
        let found = JumpSearch::new(&velocity, 8).find();
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].left, found[0].gap), (50, 1));
        assert_eq!(found[0].middle(), 50.5);
        // Both lines, extrapolated to sample 50.5, differ by the step and the slope over no time.
        assert!((found[0].height + 0.8).abs() < 1e-9, "{}", found[0].height);
        assert!(found[0].significance() > SIGNIFICANT);
    }

    #[test]
    fn valid_a_step_over_three_samples_is_measured_over_its_gap() {
        let velocity = stepped(-0.9, 3);
        let search = JumpSearch::new(&velocity, 8);
        let found = search.find();
        assert_eq!((search.gap, found.len(), found[0].left), (3, 1, 50));
        assert!((found[0].height + 0.9).abs() < 1e-9, "{}", found[0].height);
    }

    #[test]
    fn flights_that_bend_do_not_seem_to_jump_beside_an_impact() {
        // A motion of 133 samples a period with an impact in each and hardly any noise: parabolas do not follow it.
        let value = |i: usize| {
            let turns = i as f64 / 133.0;
            let since = turns.fract() * std::f64::consts::TAU;
            -0.24 * since.cos() + 0.05 * since.sin() + 0.086 * since
        };
        let mut velocity = Series::clean((0..1995).map(value).collect());
        velocity.noise = 1e-5;
        let found = JumpSearch::new(&velocity, 13).find();
        let places: Vec<usize> = found.iter().map(|jump| jump.left).collect();
        let impacts: Vec<usize> = (1..15).map(|k| 133 * k - 1).collect();
        assert_eq!(places, impacts);
    }

    #[test]
    fn valid_differences_of_a_displacement_with_a_kink_keep_both_slopes() {
        // Slopes of 0.5 before and −0.4 after a kink at 50.3; central differences mix them at 50 and 51.
        let place = |i: f64| {
            if i < 50.3 {
                0.5 * (i - 50.3)
            } else {
                -0.4 * (i - 50.3)
            }
        };
        let difference = |i: u32| 0.5 * (place(f64::from(i) + 1.0) - place(f64::from(i) - 1.0));
        let mut velocity = Series::clean((0..120).map(difference).collect());
        velocity.role = crate::record::Role::DisplacementX;
        // A noise in which a part of the step is lost.
        velocity.noise = 0.04;
        let search = JumpSearch::new(&velocity, 8);
        let found = search.find();
        assert_eq!((search.gap, found.len()), (3, 1));
        assert_eq!(found[0].left, 49);
        assert!((found[0].height + 0.9).abs() < 1e-9, "{}", found[0].height);
    }

    /// Differences of a displacement of parabolas that meet in a kink every 200 samples, or of a sine of the same size, under
    /// white noise.
    fn noisy(kinks: bool, noise: f64) -> Series {
        let place = |i: u32| {
            let share = f64::from(i) / 200.0;
            let phase = share.fract();
            if kinks {
                2.0 * phase * (phase - 1.0)
            } else {
                0.25 * (std::f64::consts::TAU * share).sin()
            }
        };
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(11);
        let normal = Normal::new(0.0, noise).expect("a deviation");
        let places: Vec<f64> = (0..4000)
            .map(|i| place(i) + normal.sample(&mut rng))
            .collect();
        let last = places.len() - 1;
        let difference = |i: usize| 0.5 * (places[(i + 1).min(last)] - places[i.saturating_sub(1)]);
        let mut velocity = Series::clean((0..places.len()).map(difference).collect());
        velocity.role = crate::record::Role::DisplacementX;
        velocity.noise = noise / SQRT_2;
        velocity
    }

    #[test]
    fn weak_kinks_of_a_noisy_displacement_are_found_where_they_recur_and_none_where_there_are_none()
    {
        for kinks in [true, false] {
            let velocity = noisy(kinks, 0.02);
            let width = window(&velocity, 200.0, 16, 50);
            assert!(width > 16);
            let search = JumpSearch::new(&velocity, width);
            let mut found = search.find();
            search.admit_recurring(Some(200.0), &mut found);
            let expected = if kinks { 19 } else { 0 };
            assert_eq!(found.len(), expected, "{found:?}");
            let at_kink =
                |j: &Jump| (j.middle() / 200.0 - (j.middle() / 200.0).round()).abs() * 200.0;
            assert!(found.iter().all(|j| at_kink(j) < 6.0), "{found:?}");
        }
    }

    #[test]
    fn a_step_counts_once_and_with_its_direction() {
        for (height, counted) in [(0.8, (1, 0)), (-0.8, (0, 1))] {
            let velocity = stepped(height, 1);
            assert_eq!(JumpSearch::new(&velocity, 8).directions(), counted);
        }
    }

    #[test]
    fn a_step_within_the_noise_is_found_only_with_support() {
        // The step is 4 standard errors of its height: too few alone, enough beside a pulse.
        let flat = stepped(0.0, 1);
        let error = JumpSearch::new(&flat, 8)
            .measure(50, &[], f64::NEG_INFINITY)
            .unwrap()
            .error;
        let velocity = stepped(-4.0 * error, 1);
        let search = JumpSearch::new(&velocity, 8);
        assert!(search.find().is_empty());
        let near = search.near(48, 52, &[], SUPPORTED).unwrap();
        assert_eq!(near.left, 50);
    }
}
