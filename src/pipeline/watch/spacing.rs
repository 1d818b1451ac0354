//! When the fit is made again while records arrive: so rarely that watching a campaign costs at most three
//! times the processor time of one run.
//!
//! With the processor time o of observing the records so far, s of all fits so far and c of the last one,
//! another is made only while s + c ≤ 1.8 (o + c). A later fit costs no less than an earlier one, so s never
//! exceeds 1.8 times what a run would then take to observe and to fit; with the observing and the fit at
//! the end that is at most 2.8 runs.

use std::time::Duration;

/// A first fit is made from so many usable records on, or of fewer when no more arrive.
const FIRST: usize = 8;
/// Growth of the number of usable records after which the fit is made again.
const GROWTH: f64 = 1.5;
/// Share of a run's time that the fits may take while the records grow.
const WHILE_GROWING: f64 = 1.2;
/// Share that they may take in all; what is left of it is for the times when nothing arrives.
const WHILE_IDLE: f64 = 1.8;

/// The processor time spent so far, and on what.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spacing {
    /// No record has arrived for so long: a good time for a fit.
    idle: Duration,
    observing: Duration,
    fitting: Duration,
    last: Option<Last>,
}

/// The last fit.
#[derive(Debug, Clone, Copy)]
struct Last {
    cost: Duration,
    records: usize,
}

impl Spacing {
    /// Nothing is spent yet; when nothing has arrived for `idle`, it is time for a fit.
    pub(super) fn new(idle: Duration) -> Self {
        Self {
            idle,
            observing: Duration::ZERO,
            fitting: Duration::ZERO,
            last: None,
        }
    }

    /// Records were observed.
    pub(super) fn observed(&mut self, cost: Duration) {
        self.observing += cost;
    }

    /// Something beside observing and fitting was done, which a run does not do.
    pub(super) fn managed(&mut self, cost: Duration) {
        self.fitting += cost;
    }

    /// So many usable records were fitted, and the results written.
    pub(super) fn fitted(&mut self, cost: Duration, records: usize) {
        self.fitting += cost;
        self.last = Some(Last { cost, records });
    }

    /// Whether to fit so many usable records now, of which some have arrived since the last fit; the
    /// last of them `since` ago.
    pub(super) fn is_due(&self, records: usize, since: Duration) -> bool {
        let idle = since >= self.idle;
        let Some(last) = self.last else {
            return records >= FIRST || (records > 0 && idle);
        };
        let grown = records as f64 >= GROWTH * last.records as f64;
        (grown && self.affords(last.cost, WHILE_GROWING))
            || (idle && self.affords(last.cost, WHILE_IDLE))
    }

    fn affords(&self, cost: Duration, share: f64) -> bool {
        let run = (self.observing + cost).as_secs_f64();
        (self.fitting + cost).as_secs_f64() <= share * run
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IDLE: Duration = Duration::from_secs(20);

    fn seconds(s: f64) -> Duration {
        Duration::from_secs_f64(s)
    }

    #[test]
    fn the_first_fit_waits_for_some_records_or_for_a_pause() {
        let spacing = Spacing::new(IDLE);
        assert!(!spacing.is_due(0, 2 * IDLE));
        assert!(!spacing.is_due(FIRST - 1, seconds(1.0)));
        assert!(spacing.is_due(FIRST - 1, IDLE));
        assert!(spacing.is_due(FIRST, Duration::ZERO));
    }

    #[test]
    fn another_fit_waits_for_growth_or_a_pause_and_for_its_share() {
        let mut spacing = Spacing::new(IDLE);
        spacing.observed(seconds(1.0));
        spacing.fitted(seconds(1.0), 10);
        // 2 s ≤ 1.2 (1 s + 1 s)
        assert!(spacing.is_due(15, Duration::ZERO));
        assert!(!spacing.is_due(14, Duration::ZERO));
        assert!(spacing.is_due(11, IDLE));
        spacing.fitted(seconds(1.0), 15);
        // 3 s ≤ 1.8 (1 s + 1 s) alone
        assert!(!spacing.is_due(40, Duration::ZERO));
        assert!(spacing.is_due(16, IDLE));
        spacing.managed(seconds(0.7));
        assert!(!spacing.is_due(40, IDLE));
    }

    /// Costs of a campaign: observing a record, and a fit of n records as a + b n^p.
    #[derive(Debug, Clone, Copy)]
    struct Costs {
        observe: f64,
        fit: (f64, f64, f64),
    }

    impl Costs {
        fn fit(&self, records: usize) -> f64 {
            let (a, b, p) = self.fit;
            a + b * (records as f64).powf(p)
        }

        /// Watching against one run, when `records` have arrived one by one, with a pause after some.
        fn ratio(&self, records: usize, pause: impl Fn(usize) -> bool) -> (f64, usize) {
            let mut spacing = Spacing::new(IDLE);
            let (mut spent, mut fits) = (0.0, 0);
            for n in 1..=records {
                spacing.observed(seconds(self.observe));
                let since = if pause(n) { IDLE } else { Duration::ZERO };
                if spacing.is_due(n, since) {
                    spacing.fitted(seconds(self.fit(n)), n);
                    spent += self.fit(n);
                    fits += 1;
                }
            }
            let run = records as f64 * self.observe + self.fit(records);
            ((run + spent) / run, fits)
        }
    }

    #[test]
    fn hundreds_of_records_one_by_one_cost_less_than_three_runs() {
        // as measured: the development profile, and a release build
        for costs in [
            Costs {
                observe: 2e-3,
                fit: (1.2, 0.11, 1.0),
            },
            Costs {
                observe: 1.6e-3,
                fit: (1.0, 1.5e-3, 1.0),
            },
        ] {
            for (records, pause) in [(846, false), (846, true), (60, true)] {
                let (ratio, fits) = costs.ratio(records, |_| pause);
                assert!(ratio < 3.0 && fits >= 2, "{costs:?}: {ratio}, {fits} fits");
            }
        }
    }

    proptest::proptest! {
        #[test]
        fn prop_watching_costs_at_most_three_runs_whenever_it_ends(
            observe in 1e-4..1.0,
            fit in (0.0..10.0, 1e-4..1.0, 0.0..2.0),
            records in 1..300usize,
            pauses in proptest::collection::vec(proptest::bool::ANY, 300),
        ) {
            let costs = Costs { observe, fit };
            let (ratio, _) = costs.ratio(records, |n| pauses[n - 1]);
            proptest::prop_assert!(ratio <= 3.0 + 1e-9, "{}", ratio);
        }
    }
}
