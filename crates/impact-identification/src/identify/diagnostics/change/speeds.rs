//! What the speed of impacts explains of R in the parts of a campaign.

use impact_fit::methods::impacts::block::SpeedPair;
use impact_records::signal::robust;

/// By how much R of impacts of one speed is another in a part; `None` where all impacts are in one part.
pub(super) fn apart_at_one_speed(pairs: &[SpeedPair], inside: &[bool]) -> Option<f64> {
    let part = |p: &SpeedPair| f64::from(inside[p.observation]);
    if pairs.iter().all(|p| inside[p.observation]) || !pairs.iter().any(|p| inside[p.observation]) {
        return None;
    }
    // what the speed does not explain of R, and of which part an impact is of
    let beyond_speed = |of: &dyn Fn(&SpeedPair) -> f64| {
        let points: Vec<[f64; 2]> = pairs.iter().map(|p| [p.before_m_s.ln(), of(p)]).collect();
        let slope = slope(&points);
        points.into_iter().map(move |[x, y]| y - slope * x)
    };
    let ratios = beyond_speed(&|p| p.after_m_s / p.before_m_s);
    let points = beyond_speed(&part).zip(ratios).map(<[f64; 2]>::from);
    Some(slope(&points.collect::<Vec<_>>()))
}

/// Whether impacts inside and outside a group differ in R by more than over their speeds.
pub(super) fn explains_more_than_speed(inside: &[usize], pairs: &[SpeedPair]) -> bool {
    let left = |of: &dyn Fn(&SpeedPair) -> f64| {
        let ratio = |p: &SpeedPair| p.after_m_s / p.before_m_s;
        let points: Vec<[f64; 2]> = pairs.iter().map(|p| [of(p), ratio(p)]).collect();
        let slope = slope(&points);
        let rest: Vec<f64> = points.iter().map(|[x, y]| y - slope * x).collect();
        let mean = robust::mean(&rest);
        rest.iter().map(|r| (r - mean).powi(2)).sum::<f64>()
    };
    left(&|p| inside[p.observation] as f64) <= left(&|p| p.before_m_s)
}

/// Slope of the line of least squares through points; zero where all have one place.
pub(super) fn slope(points: &[[f64; 2]]) -> f64 {
    let count = points.len().max(1) as f64;
    let [x, y] = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count);
    let width: f64 = points.iter().map(|p| (p[0] - x).powi(2)).sum();
    let along: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    if width > 0.0 { along / width } else { 0.0 }
}
