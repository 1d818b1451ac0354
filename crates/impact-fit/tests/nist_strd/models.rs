//! The models of the sets, as their files give them: of the unknowns b1, b2, … and the predictors.

use std::f64::consts::PI;

use super::dual::Dual;

/// A model.
pub(super) type Model = fn(&[Dual], &[f64]) -> Dual;

/// Every set with its model.
pub(super) const ALL: [(&str, Model); 27] = [
    ("Bennett5", |b, x| b[0] * (b[1] + x[0]).to(-(1.0 / b[2]))),
    ("BoxBOD", saturating),
    ("Chwirut1", decaying_quotient),
    ("Chwirut2", decaying_quotient),
    ("DanWood", |b, x| b[0] * b[1].of_base(x[0])),
    ("ENSO", |b, x| {
        let turn = |period: Dual| 2.0 * PI * x[0] / period;
        let year = 2.0 * PI * x[0] / 12.0;
        b[0] + b[1] * year.cos()
            + b[2] * year.sin()
            + b[4] * turn(b[3]).cos()
            + b[5] * turn(b[3]).sin()
            + b[7] * turn(b[6]).cos()
            + b[8] * turn(b[6]).sin()
    }),
    ("Eckerle4", |b, x| {
        b[0] / b[1] * (-0.5 * ((x[0] - b[2]) / b[1]).powi(2)).exp()
    }),
    ("Gauss1", two_bells),
    ("Gauss2", two_bells),
    ("Gauss3", two_bells),
    ("Hahn1", cubics),
    ("Kirby2", |b, x| {
        polynomial(&b[..3], x[0]) / (1.0 + x[0] * polynomial(&b[3..], x[0]))
    }),
    ("Lanczos1", three_decays),
    ("Lanczos2", three_decays),
    ("Lanczos3", three_decays),
    ("MGH09", |b, x| {
        b[0] * (x[0] * x[0] + x[0] * b[1]) / (x[0] * x[0] + x[0] * b[2] + b[3])
    }),
    ("MGH10", |b, x| b[0] * (b[1] / (x[0] + b[2])).exp()),
    ("MGH17", |b, x| {
        b[0] + b[1] * (-x[0] * b[3]).exp() + b[2] * (-x[0] * b[4]).exp()
    }),
    ("Misra1a", saturating),
    ("Misra1b", |b, x| {
        b[0] * (1.0 - (1.0 + b[1] * x[0] / 2.0).powi(-2))
    }),
    ("Misra1c", |b, x| {
        b[0] * (1.0 - (1.0 + 2.0 * b[1] * x[0]).powf(-0.5))
    }),
    ("Misra1d", |b, x| b[0] * b[1] * x[0] / (1.0 + b[1] * x[0])),
    ("Nelson", |b, x| b[0] - b[1] * x[0] * (-x[1] * b[2]).exp()),
    ("Rat42", |b, x| b[0] / (1.0 + (b[1] - b[2] * x[0]).exp())),
    ("Rat43", |b, x| {
        b[0] / (1.0 + (b[1] - b[2] * x[0]).exp()).to(1.0 / b[3])
    }),
    ("Roszman1", |b, x| {
        b[0] - b[1] * x[0] - (b[2] / (x[0] - b[3])).atan() / PI
    }),
    ("Thurber", cubics),
];

fn polynomial(coefficients: &[Dual], x: f64) -> Dual {
    let (last, others) = coefficients.split_last().unwrap();
    others.iter().rev().fold(*last, |sum, c| sum * x + *c)
}

fn saturating(b: &[Dual], x: &[f64]) -> Dual {
    b[0] * (1.0 - (-x[0] * b[1]).exp())
}

fn decaying_quotient(b: &[Dual], x: &[f64]) -> Dual {
    (-x[0] * b[0]).exp() / (b[1] + b[2] * x[0])
}

fn two_bells(b: &[Dual], x: &[f64]) -> Dual {
    let bell = |height: Dual, centre: Dual, width: Dual| {
        height * (-((x[0] - centre) / width).powi(2)).exp()
    };
    b[0] * (-x[0] * b[1]).exp() + bell(b[2], b[3], b[4]) + bell(b[5], b[6], b[7])
}

fn cubics(b: &[Dual], x: &[f64]) -> Dual {
    polynomial(&b[..4], x[0]) / (1.0 + x[0] * polynomial(&b[4..], x[0]))
}

fn three_decays(b: &[Dual], x: &[f64]) -> Dual {
    let decay = |height: Dual, rate: Dual| height * (-x[0] * rate).exp();
    decay(b[0], b[1]) + decay(b[2], b[3]) + decay(b[4], b[5])
}
