//! The loop over the steps, with all lanes at work as long as there are cells.

use super::cell::{Cell, Course, Feed, Outcome};
use super::exits::{come_to_rest, serve};
use super::lane::{IDLE, Lane, empty_group, load, park};
use super::step::{Constants, Group, step};
use crate::atlas::lanes::Lanes;
use crate::model::SettledMotion;

/// Lanes of the widest kernel.
const MAX_WIDTH: usize = 32;

/// March all cells of a feed.
#[inline(always)]
pub(super) fn march<V: Lanes, const DEGREE: usize>(course: &Course, feed: &mut impl Feed) {
    let omega = (1.0 - course.damping_ratio * course.damping_ratio).sqrt();
    let c = Constants {
        beta: V::splat(course.damping_ratio),
        minus_beta: V::splat(-course.damping_ratio),
        minus_two_beta: V::splat(-2.0 * course.damping_ratio),
        omega: V::splat(omega),
        minus_inverse_omega: V::splat(-1.0 / omega),
        minus_restitution: V::splat(-course.restitution),
        quarter_omega: V::splat(0.25 * omega),
        quarter_beta: V::splat(0.25 * course.damping_ratio),
    };
    let mut group = empty_group::<V>();
    let mut lanes = [IDLE; MAX_WIDTH];
    let mut live = 0u32;
    for (lane, info) in lanes.iter_mut().enumerate().take(V::WIDTH) {
        live |= refill(course, feed, &mut group, info, lane);
    }
    while live != 0 {
        let e = step::<V, DEGREE>(&c, &mut group);
        let mut bits = e.any() & live;
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let info = &mut lanes[lane];
            if serve(course, feed, &mut group, info, (lane, &e)) {
                live &= !(1 << lane);
                live |= refill(course, feed, &mut group, info, lane);
            }
        }
    }
}

/// Load the next cell into a lane; returns the lane's bit, or 0 where no cell is left. A mass
/// that starts at rest at the stop and is never let go is done at once.
#[inline(never)]
fn refill<V: Lanes>(
    course: &Course,
    feed: &mut impl Feed,
    s: &mut Group<V>,
    info: &mut Lane,
    lane: usize,
) -> u32 {
    while let Some((index, cell)) = feed.next() {
        load(course, s, info, lane, (index, cell));
        let rests = cell.x >= cell.rho && cell.v.abs() <= 1e-12;
        if rests {
            feed.rests(index);
        }
        if !rests || !come_to_rest(course, s, info, lane, (0.0, cell.phase)) {
            return 1 << lane;
        }
        let end = Cell {
            x: cell.rho,
            v: 0.0,
            ..cell
        };
        feed.done(
            index,
            Outcome {
                motion: SettledMotion::Sticking,
                end,
            },
        );
    }
    park(s, lane);
    0
}
