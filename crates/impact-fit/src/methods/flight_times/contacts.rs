//! What the length of contacts leaves open of R: a flight begins where a contact opens, not where it closes.

use crate::methods::flight_times::rows::{Fitted, Row};
use crate::methods::flight_times::scatter::{ContactLength, RowEstimate, contact_length};
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Least and greatest length of the contact of a ball, s: of steel on glass, and of a basketball. Without a
/// statement each factor between them is as likely.
const USUAL_S: [f64; 2] = [5e-5, 2e-2];
/// Lengths that are tried.
const LENGTHS: usize = 61;

/// What the length of contacts changes of R.
pub(super) struct ByContacts {
    /// Expected change of R from that of contacts without length.
    pub(super) change: f64,
    /// Standard error of R by it.
    pub(super) error: f64,
    /// Whether nothing states the length.
    pub(super) is_open: bool,
}

impl ByContacts {
    /// Of rows with their fits and what each tells of R, whose times are those at which contacts close; `stated_s`: the times'
    /// standard error as their source states it.
    pub(super) fn of(
        rows: &[(&Row, Fitted)],
        estimates: &[&RowEstimate],
        observations: &[Observation],
        stated_s: Option<f64>,
    ) -> Self {
        let lasting = rows.iter().flat_map(|(row, _)| {
            let impacts = observations[row.record].impacts.iter();
            impacts.filter_map(|i| i.contact_duration_s)
        });
        let weighted = Weighted { rows, estimates };
        match robust::median(&lasting.collect::<Vec<_>>()) {
            Some(length_s) => weighted.listed(length_s),
            None => weighted.open(contact_length(rows, stated_s)),
        }
    }
}

/// Rows with the weights of their records.
struct Weighted<'a> {
    rows: &'a [(&'a Row, Fitted)],
    estimates: &'a [&'a RowEstimate],
}

impl Weighted<'_> {
    /// Where the list has both edges: the length is that of the touch, or that of a pulse that an instrument makes
    /// longer. R is as likely to be anything between.
    fn listed(&self, length_s: f64) -> ByContacts {
        let change = self.change(length_s);
        ByContacts {
            change: 0.0,
            error: change.abs() / 3f64.sqrt(),
            is_open: false,
        }
    }

    /// Where the list has the beginnings alone: over the usual lengths, as likely as the ratios of flights make them.
    fn open(&self, shown: Option<ContactLength>) -> ByContacts {
        let flights = self.rows.iter().flat_map(|(row, _)| row.times_s.windows(2));
        let shortest_s = flights.map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let [least, greatest] = USUAL_S.map(|s| s.min(0.5 * shortest_s).ln());
        let lengths = (0..LENGTHS).map(|k| {
            let share = k as f64 / (LENGTHS - 1) as f64;
            (least + share * (greatest - least)).exp()
        });
        let each = lengths.map(|length_s| {
            let likely = shown.map_or(1.0, |shown| shown.likelihood(length_s));
            (likely, self.change(length_s))
        });
        let each: Vec<(f64, f64)> = each.collect();
        let all: f64 = each.iter().map(|(likely, _)| likely).sum();
        let mean = |of: &dyn Fn(f64) -> f64| {
            let parts = each.iter().map(|(likely, change)| likely * of(*change));
            parts.sum::<f64>() / all
        };
        let change = mean(&|change| change);
        ByContacts {
            change,
            error: mean(&|own| (own - change).powi(2)).sqrt(),
            is_open: true,
        }
    }

    /// Change of R by contacts of one length, the mean over the records by their weights.
    fn change(&self, length_s: f64) -> f64 {
        let weight = |own: &RowEstimate| own.error.max(1e-9).powi(-2);
        let all: f64 = self.estimates.iter().map(|own| weight(own)).sum();
        let each = self.rows.iter().zip(self.estimates);
        let changes = each.map(|((row, _), own)| weight(own) * change(&row.times_s, own, length_s));
        changes.sum::<f64>() / all
    }
}

/// Change of a row's R where each contact lasts so long; zero where a flight would be shorter than that.
fn change(times_s: &[f64], own: &RowEstimate, length_s: f64) -> f64 {
    let ratios = times_s.windows(3).zip(&own.weights);
    let changes = ratios.map(|(t, weight)| {
        let flights = [t[1] - t[0], t[2] - t[1]];
        let share = |flight: f64| (1.0 - length_s / flight).max(0.0).ln();
        weight * (share(flights[1]) - share(flights[0]))
    });
    let logarithm: f64 = changes.sum();
    if logarithm.is_finite() {
        own.restitution * logarithm.exp_m1()
    } else {
        0.0
    }
}
