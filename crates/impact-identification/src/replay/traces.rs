//! The channels of a record beside a simulation.
//!
//! What is measured is corrected from its record alone, so that a simulation of another motion leaves it
//! as it is: a channel's drift is what it changes from one period of the motion to the next, and measured
//! and simulated values are shown about their means, as no channel measures a constant part.

use crate::identify::replay::{Replay, Stretch};
use impact_records::event::{Impact, Kinematics};
use impact_records::record::{Record, Role};
use impact_records::signal::drift::{fitted_line, strobed_slope};
use impact_records::signal::robust::{mean, rms};
use impact_records::signal::whole;
use labfiles::units::Dimension;

/// A sampled signal on its own time axis.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Signal {
    /// Time, s.
    pub time_s: Vec<f64>,
    /// Values, SI, one per time.
    pub values: Vec<f64>,
}

/// One channel of a comparison: measured, simulated, and their difference.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// What the channel measures.
    pub role: Role,
    /// Its dimension, hence its SI unit.
    pub dimension: Dimension,
    /// As measured; a motion less its drift and about its mean.
    pub measured: Signal,
    /// As simulated about its mean, if the model has it.
    pub simulated: Option<Signal>,
    /// Measured less simulated.
    pub residual: Option<Signal>,
    /// Of each sample whether it lies clear of every contact: samples of a contact show neither flight.
    pub is_clear: Vec<bool>,
}

impl Trace {
    /// The residual clear of the contacts; `None` without a simulation.
    pub fn clear_residual(&self) -> Option<Vec<f64>> {
        Some(self.clear(self.residual.as_ref()?))
    }

    /// Root mean squares of residual and of measured values, clear of the contacts; `None` without a simulation.
    pub fn residual_and_whole(&self) -> Option<[f64; 2]> {
        let residual = self.clear_residual().filter(|r| !r.is_empty())?;
        Some([rms(&residual), rms(&self.clear(&self.measured))])
    }

    fn clear(&self, signal: &Signal) -> Vec<f64> {
        let samples = signal.values.iter().zip(&self.is_clear);
        samples.filter(|(_, clear)| **clear).map(|s| *s.0).collect()
    }
}

/// Greatest residual of a channel over its own size.
pub(super) fn largest_residual(traces: &[Trace]) -> f64 {
    let ratios = traces.iter().filter_map(|t| {
        let [residual, whole] = t.residual_and_whole()?;
        Some(residual / whole)
    });
    ratios.fold(0.0, f64::max)
}

/// What of a record is shown, and beside what.
pub(super) struct Cut<'a> {
    /// The stretch.
    pub stretch: Stretch,
    /// After what time its motion repeats, s; `None` of one that does not.
    pub repeats_after_s: Option<f64>,
    /// Its impacts.
    pub impacts: &'a [Impact],
    /// The simulation beside it.
    pub simulation: Option<&'a Replay>,
}

/// The moving channels beside their simulation, then what is measured alone.
pub(super) fn traces(record: &Record, k: &Kinematics, cut: &Cut<'_>) -> Vec<Trace> {
    let (length, velocity) = (Dimension::Length, Dimension::Velocity);
    let moving = [
        (Role::DisplacementX, length, &k.x.displacement),
        (Role::DisplacementY, length, &k.y.displacement),
        (Role::VelocityX, velocity, &k.x.velocity),
        (Role::VelocityY, velocity, &k.y.velocity),
    ];
    let compared = moving.into_iter().filter_map(|(role, dimension, series)| {
        let values = &series.as_ref()?.values;
        Some(cut.compared(role, dimension, values, k.rate_hz))
    });
    let others = [Role::Contact, Role::FrameX, Role::FrameY].into_iter();
    let measured_alone = others.filter_map(|role| {
        let channel = record.channel(role)?;
        let measured = cut.samples(&channel.values, record.sample_rate_hz);
        Some(Trace {
            role,
            dimension: channel.dimension,
            is_clear: vec![true; measured.values.len()],
            measured,
            simulated: None,
            residual: None,
        })
    });
    compared.chain(measured_alone).collect()
}

impl Cut<'_> {
    /// The samples of the stretch, their time counted from its start.
    fn samples(&self, values: &[f64], rate_hz: f64) -> Signal {
        let Stretch {
            start_s, length_s, ..
        } = self.stretch;
        let first = whole::index((start_s * rate_hz).ceil());
        let end = whole::index(((start_s + length_s) * rate_hz).floor()) + 1;
        let range = first.min(values.len())..end.min(values.len());
        let time_s = range.clone().map(|i| i as f64 / rate_hz - start_s);
        Signal {
            time_s: time_s.collect(),
            values: values[range].to_vec(),
        }
    }

    /// One channel beside its simulation.
    fn compared(&self, role: Role, dimension: Dimension, values: &[f64], rate_hz: f64) -> Trace {
        let mut measured = self.samples(values, rate_hz);
        let drift = self.drift_per_s(values, rate_hz);
        for (t, value) in measured.time_s.iter().zip(&mut measured.values) {
            *value -= drift * t;
        }
        centre(&mut measured.values);
        let simulated = self.simulation.and_then(|s| {
            let mut values = s.values(role, &measured.time_s)?;
            centre(&mut values);
            Some(values)
        });
        let signal = |values| Signal {
            time_s: measured.time_s.clone(),
            values,
        };
        let residual = simulated.as_ref().map(|simulated| {
            let pairs = measured.values.iter().zip(simulated);
            pairs.map(|(a, b)| a - b).collect()
        });
        Trace {
            role,
            dimension,
            is_clear: self.clear_of_contacts(&measured.time_s, rate_hz),
            simulated: simulated.map(signal),
            residual: residual.map(signal),
            measured,
        }
    }

    /// Drift of a channel, from the record alone: what it changes by from one period of the motion to the next;
    /// of a motion that does not repeat the slope of the line through the record.
    fn drift_per_s(&self, values: &[f64], rate_hz: f64) -> f64 {
        let period = self.repeats_after_s.map(|s| s * rate_hz);
        let periods = period.filter(|p| 2.0 * p < values.len() as f64);
        match periods {
            Some(period) => strobed_slope(values, period) * rate_hz,
            None => {
                let times: Vec<f64> = (0..values.len()).map(|i| i as f64 / rate_hz).collect();
                fitted_line(&times, values).1
            }
        }
    }

    /// Of each time whether it lies clear of every contact, measured or simulated, by a sample at least.
    fn clear_of_contacts(&self, times_s: &[f64], rate_hz: f64) -> Vec<bool> {
        let start_s = self.stretch.start_s;
        let measured = self.impacts.iter().map(|i| {
            let lasting = i.contact_duration_s.unwrap_or(0.0);
            (i.time_s - start_s, lasting + i.dead_zone_s)
        });
        let simulated = self.simulation.into_iter().flat_map(|s| &s.impacts_s);
        let contacts: Vec<(f64, f64)> = measured.chain(simulated.map(|t| (*t, 0.0))).collect();
        let step_s = 1.0 / rate_hz;
        let touches = |t: &f64, (at, lasting): &(f64, f64)| {
            (at - lasting - step_s..=at + lasting + step_s).contains(t)
        };
        let clear = |t: &f64| !contacts.iter().any(|c| touches(t, c));
        times_s.iter().map(clear).collect()
    }
}

fn centre(values: &mut [f64]) {
    let mean = mean(values);
    for value in values {
        *value -= mean;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::event::DriveTone;

    fn cut(phase_rad: f64, periods: f64, impacts: &[Impact]) -> Cut<'_> {
        let drive = DriveTone {
            phase_rad,
            ..DriveTone::at(10.0, 1.0)
        };
        Cut {
            stretch: Stretch {
                drive,
                start_s: 0.1 * (1.0 - phase_rad / std::f64::consts::TAU),
                length_s: 0.1 * periods,
            },
            repeats_after_s: Some(0.1),
            impacts,
            simulation: None,
        }
    }

    fn ramp(samples: usize) -> Vec<f64> {
        (0..samples).map(|i| i as f64).collect()
    }

    #[test]
    fn the_samples_of_a_stretch_are_those_within_it_and_end_with_the_record() {
        let quarter = cut(0.25 * std::f64::consts::TAU, 2.0, &[]);
        // 75.075 and 275.275 samples
        let found = quarter.samples(&ramp(400), 1001.0);
        assert_eq!((found.values[0], found.values.len()), (76.0, 200));
        assert!((found.time_s[0] - 0.925 / 1001.0).abs() < 1e-12);
        let found = cut(0.0, 4.0, &[]).samples(&ramp(250), 1000.0);
        assert_eq!((found.values[0], found.values.len()), (100.0, 150));
    }

    /// A saw tooth of 10 Hz with an offset of 3 and a drift of 0.5 a second.
    fn saw(drifts: bool) -> Vec<f64> {
        let value = |i: usize| {
            let t = i as f64 / 1000.0;
            let tooth = (10.0 * t).fract();
            tooth + if drifts { 3.0 + 0.5 * t } else { 0.0 }
        };
        (0..1000).map(value).collect()
    }

    #[test]
    fn valid_drift_and_offset_of_a_periodic_channel_are_found_from_the_record_alone() {
        let [bent, clean] = [true, false].map(|drifts| {
            let trace = cut(0.0, 4.0, &[]).compared(
                Role::DisplacementX,
                Dimension::Length,
                &saw(drifts),
                1000.0,
            );
            trace.measured.values
        });
        let apart = bent.iter().zip(&clean).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-9);
        // a line through the saw tooth itself would have a slope
        let least = clean.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((least + 0.5).abs() < 0.01, "{least}");
    }

    #[test]
    fn samples_within_one_of_a_contact_and_during_it_are_not_clear() {
        let mut lasting = Impact::at(0.150, 1.0);
        lasting.contact_duration_s = Some(2.5e-3);
        let impacts = [Impact::at(0.1205, 1.0), lasting];
        let cut = cut(0.0, 1.0, &impacts);
        let clear = cut.clear_of_contacts(
            &ramp(100).iter().map(|i| i / 1000.0).collect::<Vec<_>>(),
            1000.0,
        );
        let touching: Vec<usize> = (0..100).filter(|i| !clear[*i]).collect();
        assert_eq!(touching, [20, 21, 47, 48, 49, 50, 51, 52, 53]);
    }

    #[test]
    fn the_largest_residual_counts_relative_to_its_own_channel_and_clear_of_contacts() {
        let trace = |measured: f64, residual: Option<f64>| {
            let signal = |values: Vec<f64>| Signal {
                time_s: vec![0.0, 1.0, 2.0],
                values,
            };
            Trace {
                role: Role::VelocityX,
                dimension: Dimension::Velocity,
                measured: signal(vec![measured, 5.0, -measured]),
                simulated: None,
                residual: residual.map(|v| signal(vec![v, 100.0, -v])),
                is_clear: vec![true, false, true],
            }
        };
        let traces = [
            trace(2.0, Some(0.1)),
            trace(0.1, Some(0.02)),
            trace(1.0, None),
        ];
        assert!((largest_residual(&traces) - 0.2).abs() < 1e-12);
        assert_eq!(largest_residual(&traces[2..]), 0.0);
    }
}
