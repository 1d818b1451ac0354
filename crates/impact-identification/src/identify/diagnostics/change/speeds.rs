//! What the speed of impacts explains of R in the parts of a campaign.

use impact_fit::methods::impacts::block::ImpactBlock;

/// R of one impact over its closing speed: by errors the two are independent.
pub(super) struct Impacted {
    /// Index of its record among the observations.
    pub(super) observation: usize,
    /// Closing speed by both speeds, m/s.
    pub(super) speed_m_s: f64,
    /// R.
    pub(super) ratio: f64,
    /// Inverse variance of R.
    pub(super) weight: f64,
}

/// R of each impact of a block.
pub(super) fn impacts(block: &ImpactBlock) -> Vec<Impacted> {
    let Some(typical) = block.typical_ratio() else {
        return Vec::new();
    };
    let of = |p| {
        let speed_m_s = block.closing_speed(p, typical);
        Impacted {
            observation: p.observation,
            speed_m_s,
            ratio: typical + (p.after_m_s - typical * p.before_m_s) / speed_m_s,
            weight: (speed_m_s / block.error(p, typical)).powi(2),
        }
    };
    block.pairs.iter().map(of).collect()
}

/// By how much R of impacts of one speed is another in a part; `None` where all impacts are in one part.
pub(super) fn apart_at_one_speed(block: &ImpactBlock, inside: &[bool]) -> Option<f64> {
    let impacts = impacts(block);
    let is_inside = |i: &Impacted| inside[i.observation];
    if impacts.iter().all(is_inside) || !impacts.iter().any(is_inside) {
        return None;
    }
    // what the speed does not explain of R, and of which part an impact is of
    let beyond_speed = |of: &dyn Fn(&Impacted) -> f64| {
        let line = Line::through(&impacts, |i| i.speed_m_s.ln(), of);
        let rest = |i: &Impacted| of(i) - line.slope * i.speed_m_s.ln();
        impacts.iter().map(rest).collect::<Vec<f64>>()
    };
    let ratios = beyond_speed(&|i| i.ratio);
    let parts = beyond_speed(&|i| f64::from(is_inside(i)));
    let points = impacts.iter().zip(parts).zip(ratios);
    let points: Vec<[f64; 3]> = points.map(|((i, x), y)| [x, y, i.weight]).collect();
    Some(Line::of(&points).slope)
}

/// Whether impacts inside and outside a group differ in R by more than over their speeds.
pub(super) fn explains_more_than_speed(inside: &[usize], block: &ImpactBlock) -> bool {
    let impacts = impacts(block);
    let left = |of: &dyn Fn(&Impacted) -> f64| Line::through(&impacts, of, |i| i.ratio).left;
    left(&|i| inside[i.observation] as f64) <= left(&|i| i.speed_m_s)
}

/// The line of least weighted squares through points.
pub(super) struct Line {
    /// Its slope; zero where all points have one place.
    pub(super) slope: f64,
    /// The weighted squares that it leaves.
    left: f64,
}

impl Line {
    /// That of impacts.
    pub(super) fn through<'a>(
        impacts: impl IntoIterator<Item = &'a Impacted>,
        x: impl Fn(&Impacted) -> f64,
        y: impl Fn(&Impacted) -> f64,
    ) -> Self {
        let points = impacts.into_iter().map(|i| [x(i), y(i), i.weight]);
        Self::of(&points.collect::<Vec<_>>())
    }

    /// That of places, values and weights.
    fn of(points: &[[f64; 3]]) -> Self {
        let sum = |of: &dyn Fn(&[f64; 3]) -> f64| points.iter().map(of).sum::<f64>();
        let weight = sum(&|p| p[2]);
        let [x, y] = [0, 1].map(|k| sum(&|p| p[2] * p[k]) / weight);
        let width = sum(&|p| p[2] * (p[0] - x).powi(2));
        let along = sum(&|p| p[2] * (p[0] - x) * (p[1] - y));
        let slope = if width > 0.0 { along / width } else { 0.0 };
        let left = sum(&|p| p[2] * (p[1] - y - slope * (p[0] - x)).powi(2));
        Self { slope, left }
    }
}
