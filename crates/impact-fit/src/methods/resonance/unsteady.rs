//! A channel at another time in each record, as from a recorder of its own: without its phases the others fit, and its
//! own differ from one frequency to the next.

use nalgebra::Complex;
use std::f64::consts::TAU;

use crate::methods::blocks::Blocks;
use crate::methods::resonance::block::{ResonanceBlock, ResonancePoint};
use crate::methods::resonance::fit;
use crate::methods::resonance::misfit::left_by;
use crate::methods::resonance::phases::{Misstated, Phases, SURE};
use crate::parameters::Parameters;
use impact_records::motion::{LateChannel, Response};
use impact_records::record::Role;
use impact_records::signal::robust;

/// The channel, one of the motion or the drive's, without whose phases the others fit best, if its own scatter.
pub(super) fn channel(phases: &Phases<'_>, candidates: &[Role]) -> Option<Misstated> {
    let found = candidates.iter().filter_map(|role| without(phases, *role));
    found.min_by(|a, b| a.left.total_cmp(&b.left))
}

/// What is left without the phases of one channel, if they scatter.
fn without(phases: &Phases<'_>, role: Role) -> Option<Misstated> {
    let others = without_phases(phases.blocks, role);
    let curve = fit::start(&others, &phases.evidence.nominal)?;
    let left = left_by(&others, &curve)?;
    // noise has any phase
    let seen = |r: &Response| r.amplitude() > SURE * r.error;
    let of_role = |r: &&Response| (role == Role::Drive || r.role == role) && seen(r);
    let scatter_s = scatter_s(&phases.blocks.resonance, &curve, &of_role)?;
    (scatter_s > phases.unnoticed_s()).then(|| Misstated {
        channels: vec![LateChannel::unsteady(role, scatter_s)],
        left,
    })
}

/// The blocks without a channel of the motion, or without the phases against the drive.
fn without_phases(blocks: &Blocks, role: Role) -> Blocks {
    let mut others = blocks.clone();
    for point in &mut others.resonance.points {
        point.responses.retain(|r| r.role != role);
        if role == Role::Drive {
            point.phase_error_rad = None;
        }
    }
    others.resonance.points.retain(|p| !p.responses.is_empty());
    let relative_error = others.resonance.relative_error();
    others.resonance.allow(relative_error);
    others
}

/// By how much channels are late in the records, s, from neighbours in frequency, the mean: what goes with the frequency
/// is no scatter.
fn scatter_s(
    block: &ResonanceBlock,
    curve: &Parameters,
    channels: &impl Fn(&&Response) -> bool,
) -> Option<f64> {
    let turn = |point: &ResonancePoint| -> Complex<f64> {
        let own = point.responses.iter().filter(channels);
        let turns = own.map(|r| {
            let predicted = block.response(curve, point, r.role);
            Complex::new(r.real, r.imaginary) / predicted
        });
        turns.sum()
    };
    let seen = |p: &&ResonancePoint| p.responses.iter().any(|r| channels(&r));
    let mut points: Vec<&ResonancePoint> = block.points.iter().filter(seen).collect();
    points.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let between = points.iter().zip(points.iter().skip(1)).map(|(a, b)| {
        let frequency_hz = f64::midpoint(a.frequency_hz, b.frequency_hz);
        (turn(b) * turn(a).conj()).arg() / (TAU * frequency_hz)
    });
    robust::apart_from_neighbours(&between.collect::<Vec<f64>>())
}
