//! Arithmetic with 32 digits: unevaluated sums of two binary64 numbers (Dekker 1971, Knuth). The test's own.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// high + low, |low| at most half a unit in high's last place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twice {
    /// The value rounded to binary64.
    pub high: f64,
    /// What that leaves.
    pub low: f64,
}

impl From<f64> for Twice {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

/// a + b, exactly.
fn sum(a: f64, b: f64) -> Twice {
    let high = a + b;
    let of_b = high - a;
    Twice { high, low: (a - (high - of_b)) + (b - of_b) }
}

/// a + b for |a| ≥ |b|, exactly.
fn ordered_sum(a: f64, b: f64) -> Twice {
    let high = a + b;
    Twice { high, low: b - (high - a) }
}

impl Add for Twice {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (highs, lows) = (sum(self.high, other.high), sum(self.low, other.low));
        let first = ordered_sum(highs.high, highs.low + lows.high);
        ordered_sum(first.high, first.low + lows.low)
    }
}

impl Neg for Twice {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Twice {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Twice {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high);
        ordered_sum(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Twice {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        // Long division, three digits.
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        ordered_sum(first, second) + Self::from(rest.high / other.high)
    }
}

impl Twice {
    /// The square root, by one step of Newton's method from that of the high part.
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(self.high.sqrt());
        }
        let root = Self::from(self.high.sqrt());
        let rest = self - root * root;
        let root = root + Self::from(rest.high / (2.0 * root.high));
        let rest = self - root * root;
        root + Self::from(rest.high / (2.0 * root.high))
    }

    /// Sine and cosine of a small angle by their series.
    pub fn sin_cos(self) -> (Self, Self) {
        let square = self * self;
        let (mut sin, mut cos) = (Self::from(0.0), Self::from(0.0));
        let (mut odd, mut even) = (self, Self::from(1.0));
        for k in 0..20 {
            (sin, cos) = (sin + odd, cos + even);
            let k = f64::from(2 * k);
            even = -(even * square) / Self::from((k + 1.0) * (k + 2.0));
            odd = -(odd * square) / Self::from((k + 2.0) * (k + 3.0));
        }
        (sin, cos)
    }
}
