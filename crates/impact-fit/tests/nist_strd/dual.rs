//! Numbers that carry their exact slopes over the unknowns.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Most unknowns of a set.
const MOST: usize = 9;

/// A value with its slopes over the unknowns.
#[derive(Clone, Copy)]
pub struct Dual {
    pub value: f64,
    pub slopes: [f64; MOST],
}

impl Dual {
    /// The unknown at a place.
    pub fn unknown(value: f64, place: usize) -> Self {
        let mut slopes = [0.0; MOST];
        slopes[place] = 1.0;
        Self { value, slopes }
    }

    /// A function's value with its slope over this number.
    fn through(self, value: f64, slope: f64) -> Self {
        let slopes = self.slopes.map(|s| slope * s);
        Self { value, slopes }
    }

    pub fn exp(self) -> Self {
        self.through(self.value.exp(), self.value.exp())
    }

    pub fn sin(self) -> Self {
        self.through(self.value.sin(), self.value.cos())
    }

    pub fn cos(self) -> Self {
        self.through(self.value.cos(), -self.value.sin())
    }

    pub fn atan(self) -> Self {
        self.through(self.value.atan(), (1.0 + self.value * self.value).recip())
    }

    pub fn powf(self, power: f64) -> Self {
        let slope = power * self.value.powf(power - 1.0);
        self.through(self.value.powf(power), slope)
    }

    pub fn powi(self, power: i32) -> Self {
        self.powf(f64::from(power))
    }

    /// A positive base to this number.
    pub fn of_base(self, base: f64) -> Self {
        let value = base.powf(self.value);
        self.through(value, value * base.ln())
    }

    /// A positive number to a power that is itself one.
    pub fn to(self, power: Self) -> Self {
        let value = self.value.powf(power.value);
        let slopes = [power.value * value / self.value, value * self.value.ln()];
        self.with(power, value, slopes)
    }

    /// A function of two numbers, by its value and its slope over each.
    fn with(self, other: Self, value: f64, [over_self, over_other]: [f64; 2]) -> Self {
        Self {
            value,
            slopes: std::array::from_fn(|i| {
                over_self * self.slopes[i] + over_other * other.slopes[i]
            }),
        }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, self.value * other.value, [other.value, self.value])
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let per_unit = other.value.recip();
        self.with(other, value, [per_unit, -value * per_unit])
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    fn add(self, number: f64) -> Self {
        self.through(self.value + number, 1.0)
    }
}

impl Sub<f64> for Dual {
    type Output = Self;
    fn sub(self, number: f64) -> Self {
        self.through(self.value - number, 1.0)
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    fn mul(self, number: f64) -> Self {
        self.through(self.value * number, number)
    }
}

impl Div<f64> for Dual {
    type Output = Self;
    fn div(self, number: f64) -> Self {
        self.through(self.value / number, number.recip())
    }
}

impl Add<Dual> for f64 {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        other + self
    }
}

impl Sub<Dual> for f64 {
    type Output = Dual;
    fn sub(self, other: Dual) -> Dual {
        -other + self
    }
}

impl Div<Dual> for f64 {
    type Output = Dual;
    fn div(self, other: Dual) -> Dual {
        let value = self / other.value;
        other.through(value, -value / other.value)
    }
}

impl Mul<Dual> for f64 {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        other * self
    }
}
