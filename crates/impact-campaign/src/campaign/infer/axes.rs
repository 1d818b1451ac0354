//! Axes of one sensor that turns in the motion it shows, as of a phone that twists on its spring.

use super::found::{FolderContents, InferredChannel};
use super::place::Place;
use super::roles;
use impact_records::record::Role;
use impact_records::signal::robust;

/// Change of a motion's direction from which it is told: one axis then shows cos² of it less, 3 % and more of the amplitude, as
/// damping.
const TURNS_DEG: f64 = 10.0;
/// How much of the energy of both axes is along one line, at least: of noise it is in all directions.
const ALONG: f64 = 0.5;
/// Parts of the energy at which the first half of a motion ends, and the second one.
const HALF: f64 = 0.6;
const WHOLE: f64 = 0.98;

/// Note where a motion turns from one axis of its sensor into another along a record.
pub(super) fn note_turning(some: &[Place<'_>], found: &mut FolderContents) {
    let channels = &found.channels;
    let moves = |c: &InferredChannel| c.role.is_some_and(Role::is_motion);
    let own = (0..channels.len()).filter(|i| moves(&channels[*i]));
    let beside = |own: &usize| {
        let unit = channels[*own].unit.clone();
        let others = (0..channels.len()).filter(|i| roles::is_other_axis(channels, *i));
        let others: Vec<usize> = others.filter(|i| channels[*i].unit == unit).collect();
        others
    };
    let pairs = own.flat_map(|own| beside(&own).into_iter().map(move |other| (own, other)));
    let turned = pairs.map(|(own, other)| {
        let angles = some.iter().filter_map(|place| {
            let of = |i: usize| Some(place.numbers(channels[i].find(place.set())?));
            turning_deg(&of(own)?, &of(other)?)
        });
        (angles.fold(0.0, f64::max), own, other)
    });
    let most = turned.max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((angle, own, other)) = most.filter(|(angle, ..)| *angle > TURNS_DEG) else {
        return;
    };
    let note = format!(
        "the motion turns from {} towards {} by {angle:.0}° along a record: the sensor turns with the body, or the body swings in \
         two directions; one axis alone shows that as damping, so fix the sensor, or let the body move in one direction",
        channels[own].name, channels[other].name
    );
    found.notes.push(note);
}

/// By how much the direction of a motion in the plane of two axes changes from the first half of its energy to the second;
/// `None` where either half has no direction.
fn turning_deg(x: &[f64], y: &[f64]) -> Option<f64> {
    let count = x.len().min(y.len());
    let [mean_x, mean_y] = [&x[..count], &y[..count]].map(robust::mean);
    let pairs = x.iter().zip(y);
    let plane: Vec<[f64; 2]> = pairs.map(|(x, y)| [x - mean_x, y - mean_y]).collect();
    let energy = |[x, y]: &[f64; 2]| x * x + y * y;
    let all: f64 = plane.iter().map(energy).sum();
    let end = |part: f64| {
        let mut sum = 0.0;
        let reaches = plane.iter().position(|v| {
            sum += energy(v);
            sum > part * all
        });
        reaches.unwrap_or(count)
    };
    let (half, whole) = (end(HALF), end(WHOLE));
    let first = direction_rad(&plane[..half])?;
    let second = direction_rad(plane.get(half..whole)?)?;
    let apart = (first - second).rem_euclid(std::f64::consts::PI);
    Some(apart.min(std::f64::consts::PI - apart).to_degrees())
}

/// The direction of the line along which most of a motion is, from 0 to π.
fn direction_rad(plane: &[[f64; 2]]) -> Option<f64> {
    let sum = |of: &dyn Fn(f64, f64) -> f64| plane.iter().map(|[x, y]| of(*x, *y)).sum::<f64>();
    let [xx, yy, xy] = [sum(&|x, _| x * x), sum(&|_, y| y * y), sum(&|x, y| x * y)];
    let along = (xx - yy).hypot(2.0 * xy) / (xx + yy);
    (along > ALONG).then(|| 0.5 * (2.0 * xy).atan2(xx - yy))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both axes of a decay of 2.4 Hz at 200 Hz whose sensor turns at a rate, beside noise.
    fn axes(start: f64, rate_rad_s: f64) -> [Vec<f64>; 2] {
        let noise = |i: u32| 0.01 * (2.399_963 * f64::from(i * i % 9973)).sin();
        let of = |i: u32| {
            let t = f64::from(i) / 200.0;
            let motion = (-0.45 * t).exp() * (15.0 * t).cos();
            let angle = start + rate_rad_s * t;
            [
                motion * angle.cos() + noise(i),
                motion * angle.sin() + noise(i + 7),
            ]
        };
        [0, 1].map(|k| (0..1600).map(|i| of(i)[k]).collect())
    }

    #[test]
    fn a_motion_between_two_axes_does_not_turn_and_one_of_a_twisting_phone_does() {
        for start in [0.0, 0.7, 1.5, 2.8] {
            let [x, y] = axes(start, 0.0);
            assert!(turning_deg(&x, &y).unwrap() < 2.0, "{start}");
            let [x, y] = axes(start, 0.3);
            assert!(turning_deg(&x, &y).unwrap() > 15.0, "{start}");
        }
        let noise = |factor: f64| -> Vec<f64> {
            let value = |i: u32| (factor * f64::from(i * i)).sin();
            (0..1600).map(value).collect()
        };
        assert_eq!(turning_deg(&noise(2.399_963), &noise(1.732_051)), None);
    }
}
