//! Twice the working precision for loops over rows of numbers: algorithms of Joldes, Muller and Popescu (2017), as in
//! `twofloat`, but without its calls, so that a loop becomes vector code; and quotients, of which `twofloat` 0.8 rounds
//! one step to the working precision.

use twofloat::TwoFloat;

/// A sum of two numbers, the second below half a unit of the first one's last place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twice {
    /// The value, rounded.
    pub high: f64,
    /// What rounding took.
    pub low: f64,
}

impl From<f64> for Twice {
    #[inline(always)]
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl From<TwoFloat> for Twice {
    #[inline(always)]
    fn from(value: TwoFloat) -> Self {
        Self { high: value.hi(), low: value.lo() }
    }
}

impl From<Twice> for TwoFloat {
    fn from(value: Twice) -> Self {
        Self::new_add(value.high, value.low)
    }
}

/// a/b to all digits.
pub fn quotient(a: TwoFloat, b: TwoFloat) -> TwoFloat {
    (Twice::from(a) / Twice::from(b)).into()
}

impl Twice {
    /// a + b exactly (Algorithm 2).
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let from_a = high - b;
        let from_b = high - from_a;
        Self { high, low: (a - from_a) + (b - from_b) }
    }

    /// a + b exactly where a is the larger (Algorithm 1).
    #[inline(always)]
    fn ordered_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }

    /// √self, 0 where it is not positive.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        let root = self.high.max(0.0).sqrt();
        let rest = (-root).mul_add(root, self.high) + self.low;
        Self::ordered_sum(root, if root > 0.0 { rest / (2.0 * root) } else { 0.0 })
    }
}

impl std::ops::Neg for Twice {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl std::ops::Add for Twice {
    type Output = Self;

    /// Algorithm 6.
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let first = Self::ordered_sum(high.high, high.low + low.high);
        Self::ordered_sum(first.high, low.low + first.low)
    }
}

impl std::ops::Sub for Twice {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl std::ops::Mul for Twice {
    type Output = Self;

    /// Algorithm 12.
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let rest = self.high.mul_add(other.high, -high);
        let cross = self.high.mul_add(other.low, self.low * other.low);
        Self::ordered_sum(high, rest + self.low.mul_add(other.high, cross))
    }
}

impl std::ops::Div for Twice {
    type Output = Self;

    /// Long division by two digits (Algorithm 17).
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - Self::from(first) * other;
        Self::ordered_sum(first, rest.high / other.high)
    }
}

/// Several numbers in twice the working precision: high and low parts apart, as vector code wants them.
#[derive(Debug, Clone, Copy)]
pub struct Twices<const N: usize> {
    /// The values, rounded.
    pub high: [f64; N],
    /// What rounding took.
    pub low: [f64; N],
}

impl<const N: usize> From<[f64; N]> for Twices<N> {
    #[inline(always)]
    fn from(high: [f64; N]) -> Self {
        Self { high, low: [0.0; N] }
    }
}

impl<const N: usize> Twices<N> {
    /// The k-th of them.
    #[inline(always)]
    pub fn get(&self, k: usize) -> Twice {
        Twice { high: self.high[k], low: self.low[k] }
    }

    /// Makes it the k-th.
    #[inline(always)]
    pub fn set(&mut self, k: usize, value: Twice) {
        (self.high[k], self.low[k]) = (value.high, value.low);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// |found/expected − 1|.
    fn relative(found: Twice, expected: TwoFloat) -> f64 {
        let apart = TwoFloat::from(found) - expected;
        (f64::from(apart) / f64::from(expected)).abs()
    }

    #[test]
    fn every_operation_has_all_digits() {
        let third = TwoFloat::new_div(1.0, 3.0);
        let pairs =
            [(third, TwoFloat::new_mul(1e8 + 1.0, 1.1)), (TwoFloat::from(2.5), -third), (third, third)];
        for (a, b) in pairs {
            let (x, y) = (Twice::from(a), Twice::from(b));
            for (found, expected) in
                [(x + y, a + b), (x * y, a * b), (x / y * y, a), (x.sqrt() * x.sqrt(), a)]
            {
                assert!(relative(found, expected) <= 1e-31, "{found:?} {expected:?}");
            }
            assert!(f64::from(TwoFloat::from(x - y) - (a - b)).abs() <= 1e-31 * f64::from(b).abs());
        }
        assert_eq!(Twice::from(-1.0).sqrt(), Twice::from(0.0));
    }
}
