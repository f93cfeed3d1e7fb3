//! Twice the working precision: a number as an unevaluated sum of two, with about 32 digits.
//!
//! The algorithms are those of Joldes, Muller and Popescu (2017). They call no functions, so that a loop of them over lanes becomes
//! vector code. A product needs the fused multiply-add; machines without the instruction compute it in software, to
//! the same bits.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use serde::{Deserialize, Serialize};

/// A sum of two numbers, of which the second is below half a unit of the first one's last place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Twice {
    /// The value, rounded to the working precision.
    pub high: f64,
    /// The value less `high`.
    pub low: f64,
}

impl From<f64> for Twice {
    #[inline(always)]
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl From<Twice> for f64 {
    #[inline(always)]
    fn from(value: Twice) -> Self {
        value.high
    }
}

impl Twice {
    /// Zero.
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };

    /// Computes a + b exactly (Algorithm 2).
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let from_a = high - b;
        let from_b = high - from_a;
        Self { high, low: (a - from_a) + (b - from_b) }
    }

    /// Computes a + b exactly where |a| is the larger (Algorithm 1).
    #[inline(always)]
    fn ordered_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }

    /// Computes a b exactly (Algorithm 3).
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }

    /// Computes the square root, and 0 where the number is not positive.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let root = self.high.max(0.0).sqrt();
        let rest = (-root).mul_add(root, self.high) + self.low;
        Self::ordered_sum(root, if root > 0.0 { rest / (2.0 * root) } else { 0.0 })
    }
}

impl Neg for Twice {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl<T: Into<Self>> Add<T> for Twice {
    type Output = Self;

    /// Adds by Algorithm 6.
    #[inline(always)]
    fn add(self, other: T) -> Self {
        let other = other.into();
        let (high, low) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let first = Self::ordered_sum(high.high, high.low + low.high);
        Self::ordered_sum(first.high, low.low + first.low)
    }
}

impl<T: Into<Self>> Sub<T> for Twice {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: T) -> Self {
        self + -other.into()
    }
}

impl<T: Into<Self>> Mul<T> for Twice {
    type Output = Self;

    /// Multiplies by Algorithm 12.
    #[inline(always)]
    fn mul(self, other: T) -> Self {
        let other = other.into();
        let high = Self::product(self.high, other.high);
        let cross = self.high.mul_add(other.low, self.low * other.low);
        Self::ordered_sum(high.high, high.low + self.low.mul_add(other.high, cross))
    }
}

impl<T: Into<Self>> Div<T> for Twice {
    type Output = Self;

    /// Divides by long division with two digits (Algorithm 17).
    #[inline(always)]
    fn div(self, other: T) -> Self {
        let other = other.into();
        let first = self.high / other.high;
        let rest = self - other * first;
        Self::ordered_sum(first, rest.high / other.high)
    }
}

impl<T: Into<Self>> AddAssign<T> for Twice {
    #[inline(always)]
    fn add_assign(&mut self, other: T) {
        *self = *self + other;
    }
}

impl<T: Into<Self>> SubAssign<T> for Twice {
    #[inline(always)]
    fn sub_assign(&mut self, other: T) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use twofloat::TwoFloat;

    use super::*;

    /// |found/expected − 1|, by the arithmetic of another library.
    fn relative(found: Twice, expected: TwoFloat) -> f64 {
        f64::from((TwoFloat::new_add(found.high, found.low) - expected) / expected).abs()
    }

    #[test]
    fn every_operation_has_all_digits() {
        let (third, large) = (TwoFloat::new_div(1.0, 3.0), TwoFloat::new_mul(1e8 + 1.0, 1.1));
        for (a, b) in [(third, large), (TwoFloat::from(2.5), -third), (third, third)] {
            let [x, y] = [a, b].map(|value| Twice { high: value.hi(), low: value.lo() });
            let pairs = [
                (x + y, a + b),
                (x * y, a * b),
                (x / y * y, a),
                (x.sqrt() * x.sqrt(), a),
                (x + y.high, a + b.hi()),
                (x * y.high, a * b.hi()),
                (x / y.high, a / b.hi()),
                (Twice::product(x.high, y.high), TwoFloat::new_mul(a.hi(), b.hi())),
            ];
            for (found, expected) in pairs {
                assert!(relative(found, expected) <= 1e-31, "{found:?} {expected:?}");
            }
            let apart = x - y + y - x;
            assert!(apart.high.abs() <= 1e-31 * y.high.abs());
        }
        assert_eq!(Twice::from(-1.0).sqrt(), Twice::ZERO);
    }
}
