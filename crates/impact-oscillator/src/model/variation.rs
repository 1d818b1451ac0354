//! How a variation (X, X', Y, Y') passes flights and impacts: free flow, saltation, multipliers.

use nalgebra::{Matrix2, Matrix4, Schur, Vector4};

use super::flight::{State, exponent};
use super::params::{Machine, Oscillator};
use super::path::C64;

/// Flow of the variation over a time: each mass's free vibration, block diagonal.
pub fn free_flow(machine: &Machine, time: f64) -> Matrix4<f64> {
    let mut m = Matrix4::identity();
    fill_flow(&mut m, 0, &machine.x, time);
    if let Some(y) = &machine.y {
        fill_flow(&mut m, 2, y, time);
    }
    m
}

fn fill_flow(m: &mut Matrix4<f64>, at: usize, o: &Oscillator, time: f64) {
    m.fixed_view_mut::<2, 2>(at, at)
        .copy_from(&free_flow_of_one(o, time));
}

/// Flow of the variation (X, X') of one mass over a time.
pub(crate) fn free_flow_of_one(o: &Oscillator, time: f64) -> Matrix2<f64> {
    let lambda = exponent(o);
    let (d, w) = (-lambda.re, lambda.im);
    let e = (-d * time).exp();
    let (s, c) = (w * time).sin_cos();
    Matrix2::new(
        e * (c + d * s / w),
        e * s / w,
        -e * s * o.stiffness_per_mass() / w,
        e * (c - d * s / w),
    )
}

/// Saltation matrix at an impact: which maps a variation (X, X', Y, Y') just before to one
/// just after, S = D + (f₊ − D f₋)nᵀ/w with n the gap's normal, eq. (11).
///
/// ```
/// use impact_oscillator::model::{orbit::stable_orbit, variation::saltation};
/// use impact_oscillator::{Machine, Setting};
///
/// let machine = Machine::single(0.07, 0.9);
/// let orbit = stable_orbit(&machine, Setting::new(1.2, 2.0), 1)?.expect("z = 1");
/// let map = saltation(&machine, &orbit.before, &orbit.after);
/// // an impact contracts areas of the phase plane by R²
/// assert!((map.determinant() - 0.81).abs() < 1e-9);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn saltation(machine: &Machine, before: &State, after: &State) -> Matrix4<f64> {
    let w = before.vx + before.vy;
    let slope = turned(machine, w);
    let (mx, my) = machine.mobility();
    let mut jump = Matrix4::identity();
    for (row, mobility) in [(1, mx), (3, my)] {
        jump[(row, 1)] -= mobility * slope;
        jump[(row, 3)] -= mobility * slope;
    }
    let rate = |s: &State| Vector4::new(s.vx, s.ax, s.vy, s.ay);
    let normal = Vector4::new(1.0, 0.0, 1.0, 0.0);
    jump + (rate(after) - jump * rate(before)) * normal.transpose() / w
}

/// The saltation matrix of one mass at an impact on the stop: of its variation (X, X').
pub(crate) fn saltation_of_one(machine: &Machine, before: &State, after: &State) -> Matrix2<f64> {
    let w = before.vx;
    let kept = 1.0 - machine.mobility().0 * turned(machine, w);
    let (position, speed) = (after.vx - before.vx, after.ax - kept * before.ax);
    Matrix2::new(1.0 + position / w, 0.0, speed / w, kept)
}

/// How the change of the relative velocity at an impact follows the approach speed w: d((1 + R)w)/dw.
fn turned(machine: &Machine, w: f64) -> f64 {
    let law = machine.restitution();
    1.0 + law.at(w) + w * law.slope_at(w)
}

/// Eigenvalues of a variation's map, largest modulus first; the stop's own two rows are left
/// out for a single mass. Not a number where the map is not finite.
pub fn eigenvalues(machine: &Machine, map: &Matrix4<f64>) -> Vec<C64> {
    let mut values = if !map.iter().all(|v| v.is_finite()) {
        vec![C64::new(f64::NAN, f64::NAN); if machine.y.is_some() { 4 } else { 2 }]
    } else if machine.is_symmetric() {
        [1.0, -1.0]
            .map(|sign| of_two(&like_masses(map, sign)))
            .concat()
    } else if machine.y.is_some() {
        of_four(map)
    } else {
        of_two(&map.fixed_view::<2, 2>(0, 0).into_owned())
    };
    values.sort_by(|a, b| b.norm_sqr().total_cmp(&a.norm_sqr()));
    values
}

/// What the map of two like masses makes of their common (sign 1) or opposite (sign −1) variation:
/// an impact changes the sum of their displacements alone, so that the two do not mix.
fn like_masses(map: &Matrix4<f64>, sign: f64) -> Matrix2<f64> {
    let block = |row, column| map.fixed_view::<2, 2>(row, column);
    0.5 * (block(0, 0) + block(2, 2) + sign * (block(0, 2) + block(2, 0)))
}

/// Steps after which the QR iteration of a matrix of four rows is given up; it needs about ten.
const MOST_STEPS: usize = 1000;

/// Eigenvalues by the QR iteration with a limit on its steps: where a map's last digits oscillate
/// it would not end.
fn of_four(map: &Matrix4<f64>) -> Vec<C64> {
    [f64::EPSILON, 1e3 * f64::EPSILON, 1e6 * f64::EPSILON]
        .into_iter()
        .find_map(|tolerance| Schur::try_new(*map, tolerance, MOST_STEPS))
        .map_or_else(
            || vec![C64::new(f64::NAN, f64::NAN); 4],
            |schur| schur.complex_eigenvalues().iter().copied().collect(),
        )
}

/// Eigenvalues from trace and determinant; of real ones the larger first, the smaller from the
/// product so that it keeps its digits.
fn of_two(map: &Matrix2<f64>) -> Vec<C64> {
    let (half, product) = (0.5 * map.trace(), map.determinant());
    let square = half * half - product;
    if square < 0.0 {
        let im = (-square).sqrt();
        return vec![C64::new(half, im), C64::new(half, -im)];
    }
    let large = half + square.sqrt().copysign(half);
    let small = if large == 0.0 { 0.0 } else { product / large };
    vec![C64::new(large, 0.0), C64::new(small, 0.0)]
}
