//! What lies beside decays: tones, other modes, harmonics of a sensor, a drift, slow noise.

use crate::messages::Remark;
use impact_records::signal::decay::Decay;

/// Amplitude beside a decay, over its own, that is told: of a tone, and of a drift.
const TELLING: [f64; 2] = [0.02, 0.1];
/// Widening of an interval by slow noise that is told, which changes no number: nine tenths of its variance are that
/// noise.
const WIDENING: f64 = 3.0;
/// Multiples of its frequency that a sensor shows of a decay, and how far off, relative, another mode is none by chance.
const MULTIPLES: std::ops::RangeInclusive<u32> = 2..=5;
const OFF: f64 = 5e-3;

/// How far off, relative, and how strong at least another mode is that may as well be the rig's.
const RIVAL: f64 = 0.2;
const AS_STRONG: f64 = 0.7;

/// Whether another mode is as near and as strong that it is open which of both is the rig's.
pub(super) fn has_rival(decay: &Decay) -> bool {
    let off = |hz: f64| (hz / decay.natural_frequency_hz - 1.0).abs();
    let mode = decay.beside.mode;
    mode.is_some_and(|[hz, ratio]| off(hz) < RIVAL && ratio > AS_STRONG)
}

/// What lies beside the decays, as far as it tells of the laboratory; noise of decays that fit.
pub(super) fn remarks(decays: &[&Decay], fits: bool) -> Vec<Remark> {
    let strongest = |of: &dyn Fn(&Decay) -> Option<[f64; 2]>, least: f64| {
        let all = decays.iter().filter_map(|d| of(d));
        let telling: Vec<[f64; 2]> = all.filter(|m| m[1] > least).collect();
        let most = telling.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1]));
        most.map(|[frequency_hz, ratio]| (telling.len(), frequency_hz, ratio))
    };
    let other = |d: &Decay| d.beside.mode.filter(|m| multiple(d, m[0]).is_none());
    let hum = strongest(&|d| d.beside.hum, TELLING[0]);
    let mode = strongest(&other, TELLING[0]);
    let drift = strongest(&|d| Some([0.0, d.beside.drift_ratio]), TELLING[1]);
    let noise = strongest(&|d| Some([0.0, d.beside.slow_noise]), WIDENING).filter(|_| fits);
    let hum = hum.map(|(count, frequency_hz, ratio)| Remark::DecaysHum {
        count,
        frequency_hz,
        ratio,
    });
    let mode = mode.map(|(count, frequency_hz, ratio)| Remark::DecaysMode {
        count,
        frequency_hz,
        ratio,
    });
    let drift = drift.map(|(count, _, ratio)| Remark::DecaysBackground { count, ratio });
    let noise = noise.map(|(count, _, times)| Remark::DecaysSlowNoise { count, times });
    let all = [hum, mode, harmonics(decays), drift, noise];
    all.into_iter().flatten().collect()
}

/// The two frequencies of decays that beat.
pub(super) fn beat(decays: &[&Decay]) -> Option<Remark> {
    let apart = |d: &&Decay| {
        d.beside
            .beat
            .filter(|[_, hz, _]| multiple(d, *hz).is_none())
    };
    let beating: Vec<[f64; 3]> = decays.iter().filter_map(apart).collect();
    let strongest = beating.iter().max_by(|a, b| a[2].total_cmp(&b[2]))?;
    let [first_hz, second_hz, ratio] = *strongest;
    Some(Remark::DecaysBeat {
        count: beating.len(),
        first_hz,
        second_hz,
        ratio,
    })
}

/// Harmonics of decays, as a sensor that is not linear shows them.
fn harmonics(decays: &[&Decay]) -> Option<Remark> {
    let shown = |d: &&Decay| {
        let beat = d.beside.beat.map(|[_, hz, ratio]| [hz, ratio]);
        let both = [d.beside.mode, beat].into_iter().flatten();
        let telling = both.filter(|[_, ratio]| *ratio > TELLING[0]);
        let multiples = telling.filter_map(|[hz, ratio]| Some((multiple(d, hz)?, ratio)));
        multiples.max_by(|a, b| a.1.total_cmp(&b.1))
    };
    let all: Vec<(u32, f64)> = decays.iter().filter_map(shown).collect();
    let (multiple, ratio) = *all.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Remark::DecaysHarmonic {
        count: all.len(),
        multiple: multiple as usize,
        ratio,
    })
}

/// Which multiple of a decay's frequency another one is, if it is one.
fn multiple(decay: &Decay, other_hz: f64) -> Option<u32> {
    let times = other_hz / decay.natural_frequency_hz;
    MULTIPLES
        .into_iter()
        .find(|k| (times / f64::from(*k) - 1.0).abs() < OFF)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::signal::decay;
    use std::f64::consts::TAU;

    #[test]
    fn a_mode_as_strong_and_as_near_leaves_open_which_is_the_rigs() {
        let shown = |t: f64, second: f64| {
            let of = |hz: f64, beta: f64| (-TAU * hz * beta * t).exp() * (TAU * hz * t).cos();
            of(6.0, 0.004)
                + second * of(6.18, 0.002)
                + 2e-3 * (2.399_963 * (t * 200.0).powi(2)).sin()
        };
        for (second, rival) in [(0.8, true), (0.2, false)] {
            let values: Vec<f64> = (0..4000)
                .map(|i| shown(f64::from(i) / 200.0, second))
                .collect();
            let found = decay::fit(&values, 200.0).unwrap();
            let told = found.beside.beat.is_some() || has_rival(&found);
            assert_eq!(told, rival, "{second}: {found:?}");
        }
    }

    #[test]
    fn harmonics_of_a_sensor_that_is_not_linear_are_no_mode() {
        let shown = |t: f64| {
            let place = (-TAU * 2.4 * 0.012 * t).exp() * (TAU * 2.4 * t).cos();
            let scatter = 2e-3 * (2.399_963 * (t * 200.0).powi(2)).sin();
            place + 0.15 * place * place + scatter
        };
        let values: Vec<f64> = (0..3000).map(|i| shown(f64::from(i) / 200.0)).collect();
        let found = decay::fit(&values, 200.0).unwrap();
        let all = remarks(&[&found], true);
        let named = |r: &Remark| matches!(r, Remark::DecaysHarmonic { multiple: 2, .. });
        assert!(all.iter().any(named), "{all:?}");
        let mode = |r: &Remark| matches!(r, Remark::DecaysMode { .. });
        assert!(
            !all.iter().any(mode) && beat(&[&found]).is_none(),
            "{all:?}"
        );
    }
}
