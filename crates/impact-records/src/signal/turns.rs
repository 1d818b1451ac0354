//! Cosines and sines at even steps.

use multiversion::multiversion;

/// Steps that one table of rotations covers.
const BLOCK: u32 = 64;

/// Cosines and sines of 2π·ratio·i + phase for i = 0, 1, …
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Turns {
    /// The cosines.
    pub cos: Vec<f64>,
    /// The sines.
    pub sin: Vec<f64>,
}

impl Turns {
    /// Of a frequency over the sampling rate, and the phase at i = 0, rad; as exact as the angle itself.
    pub(crate) fn new(ratio: f64, phase_rad: f64, count: usize) -> Self {
        let angle = |step: u32| std::f64::consts::TAU * (ratio * f64::from(step)).fract();
        let (sin, cos) = (0..BLOCK).map(|j| angle(j).sin_cos()).unzip();
        let table = Self { cos, sin };
        let (mut cos, mut sin) = (vec![0.0; count], vec![0.0; count]);
        let blocks = cos.chunks_mut(BLOCK as usize);
        let blocks = blocks.zip(sin.chunks_mut(BLOCK as usize));
        for (first, block) in (0..).step_by(BLOCK as usize).zip(blocks) {
            let (sin_0, cos_0) = (angle(first) + phase_rad).sin_cos();
            turned(&table, (cos_0, sin_0), block);
        }
        Self { cos, sin }
    }
}

/// The table turned by an angle, given by its cosine and sine.
#[multiversion(targets("x86_64+avx2"))]
fn turned(table: &Turns, (cos_0, sin_0): (f64, f64), (cos, sin): (&mut [f64], &mut [f64])) {
    let out = cos.iter_mut().zip(sin);
    for ((c, s), (tc, ts)) in out.zip(table.cos.iter().zip(&table.sin)) {
        *c = cos_0 * tc - sin_0 * ts;
        *s = sin_0 * tc + cos_0 * ts;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_turns_are_cosines_and_sines() {
        let (ratio, phase) = (0.006_31, 0.4);
        let found = Turns::new(ratio, phase, 1001);
        assert_eq!((found.cos.len(), found.sin.len()), (1001, 1001));
        for (i, (c, s)) in found.cos.iter().zip(&found.sin).enumerate() {
            let (sin, cos) = (std::f64::consts::TAU * ratio * i as f64 + phase).sin_cos();
            assert!((c - cos).abs() < 1e-13 && (s - sin).abs() < 1e-13, "{i}");
        }
        assert!(Turns::new(ratio, phase, 0).cos.is_empty());
    }
}
