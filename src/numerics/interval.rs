//! Intervals of one coordinate, and their arithmetic.

use std::ops::{Add, Index, IndexMut, Mul, Neg};

use serde::{Deserialize, Serialize};

/// A closed interval of one coordinate, \[low, high\], in the coordinate's unit. Ends may be infinite. In files it is the list of
/// its ends.
///
/// ```
/// use wheelrail::Interval;
///
/// let head = Interval::new(-36.0, 36.0);
/// assert!(head.contains(10.0) && head.width() == 72.0);
/// assert_eq!(head.cut(Interval::new(20.0, 50.0)), Interval::new(20.0, 36.0));
/// assert!(head.cut(Interval::new(40.0, 50.0)).is_empty());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "[f64; 2]", into = "[f64; 2]")]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Interval {
    /// All numbers.
    pub const ALL: Self = Self::new(f64::NEG_INFINITY, f64::INFINITY);
    /// No number: the hull of it and another interval is the other.
    pub const NONE: Self = Self::new(f64::INFINITY, f64::NEG_INFINITY);

    /// Makes the interval from `low` to `high`.
    #[inline(always)]
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Makes the interval that holds one number alone.
    #[inline(always)]
    pub const fn of(number: f64) -> Self {
        Self::new(number, number)
    }

    /// Makes the interval from −half to half.
    #[inline(always)]
    pub const fn symmetric(half: f64) -> Self {
        Self::new(-half, half)
    }

    /// Makes the interval between two numbers, whichever is larger.
    #[inline]
    pub fn between(a: f64, b: f64) -> Self {
        if a <= b { Self::new(a, b) } else { Self::new(b, a) }
    }

    /// Makes the smallest interval that holds some numbers: [`NONE`](Self::NONE) if there are none.
    #[inline]
    pub fn around(numbers: impl IntoIterator<Item = f64>) -> Self {
        numbers.into_iter().fold(Self::NONE, Self::with)
    }

    /// Gives both ends, the lower one first.
    #[inline(always)]
    pub const fn ends(self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// Gives high − low: negative of an empty interval.
    #[inline(always)]
    pub fn width(self) -> f64 {
        self.high - self.low
    }

    /// Gives the middle.
    #[inline(always)]
    pub fn middle(self) -> f64 {
        self.low + (self.high - self.low) / 2.0
    }

    /// Gives the lower and the upper half.
    #[inline(always)]
    pub fn halves(self) -> [Self; 2] {
        self.split(self.middle())
    }

    /// Gives the largest distance from zero in the interval.
    #[inline(always)]
    pub fn magnitude(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Gives the number at a share of the width: the lower end at 0 and, to rounding, the upper end at 1.
    #[inline(always)]
    pub fn at(self, share: f64) -> f64 {
        self.low + (self.high - self.low) * share
    }

    /// Says whether the interval holds a number, the ends included.
    #[inline(always)]
    pub fn contains(self, number: f64) -> bool {
        self.low <= number && number <= self.high
    }

    /// Says whether a number lies between the ends and is neither of them.
    #[inline(always)]
    pub fn surrounds(self, number: f64) -> bool {
        self.low < number && number < self.high
    }

    /// Says whether there is more than one number in the interval.
    #[inline(always)]
    pub fn has_width(self) -> bool {
        self.low < self.high
    }

    /// Says whether another interval lies in this one, common ends included.
    #[inline(always)]
    pub fn holds(self, other: Self) -> bool {
        self.low <= other.low && other.high <= self.high
    }

    /// Says whether both intervals share a number, an end that they share included.
    #[inline(always)]
    pub fn meets(self, other: Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    /// Says whether both intervals share more than one number.
    #[inline(always)]
    pub fn overlaps(self, other: Self) -> bool {
        self.cut(other).has_width()
    }

    /// Says whether there is no number in the interval.
    #[inline(always)]
    pub fn is_empty(self) -> bool {
        self.low > self.high
    }

    /// Gives the number of the interval that is nearest to a number; NaN of NaN.
    #[inline(always)]
    pub fn nearest(self, number: f64) -> f64 {
        // In this form the compiler uses the machine's instructions for minimum and maximum.
        let risen = if number < self.low { self.low } else { number };
        if risen > self.high { self.high } else { risen }
    }

    /// Gives the smallest interval that holds this one and a number.
    #[inline(always)]
    pub fn with(self, number: f64) -> Self {
        Self::new(self.low.min(number), self.high.max(number))
    }

    /// Gives the smallest interval that holds both.
    #[inline(always)]
    pub fn hull(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Gives what both intervals share. If they share nothing it is empty: low > high.
    #[inline(always)]
    pub fn cut(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }

    /// Gives the distance between two intervals; 0 if they meet.
    #[inline]
    pub fn distance(self, other: Self) -> f64 {
        (self.low - other.high).max(other.low - self.high).max(0.0)
    }

    /// Gives the k-th of n + 1 places in equal steps, from the lower end (0) to the upper one (n), both without rounding.
    #[inline]
    pub fn step(self, k: usize, n: usize) -> f64 {
        if k == n { self.high } else { self.low + self.width() * k as f64 / n as f64 }
    }

    /// Gives what is below and what is above a number of the interval.
    #[inline(always)]
    pub fn split(self, at: f64) -> [Self; 2] {
        [Self::new(self.low, at), Self::new(at, self.high)]
    }

    /// Gives the parts between the ends and the places inside, ascending. `places` may hold others, some twice, and be in any order.
    pub fn parts(self, mut places: Vec<f64>) -> impl Iterator<Item = Self> {
        places.retain(|place| self.surrounds(*place));
        places.sort_by(f64::total_cmp);
        places.dedup();
        let mut low = self.low;
        places
            .into_iter()
            .chain([self.high])
            .map(move |high| Self::new(std::mem::replace(&mut low, high), high))
    }

    /// Gives the interval with both ends moved outwards by `margin`.
    #[inline(always)]
    pub fn grown(self, margin: f64) -> Self {
        Self::new(self.low - margin, self.high + margin)
    }

    /// Gives the interval from `of(low)` to `of(high)`: the image under a function that ascends. One that descends swaps the ends.
    #[inline(always)]
    pub fn map(self, mut of: impl FnMut(f64) -> f64) -> Self {
        Self::new(of(self.low), of(self.high))
    }

    /// Returns the range of the squares.
    #[inline]
    pub fn squared(self) -> Self {
        Self::new(self.nearest(0.0).powi(2), self.magnitude().powi(2))
    }

    /// Divides every number of the interval by every number of a positive one.
    #[inline]
    pub fn quotient(self, positive: Self) -> Self {
        self * Self::new(positive.high.recip(), positive.low.recip())
    }
}

impl From<[f64; 2]> for Interval {
    #[inline(always)]
    fn from([low, high]: [f64; 2]) -> Self {
        Self::new(low, high)
    }
}

impl From<Interval> for [f64; 2] {
    #[inline(always)]
    fn from(interval: Interval) -> Self {
        interval.ends()
    }
}

/// An end by its number: 0 the lower one, 1 the upper one.
impl Index<usize> for Interval {
    type Output = f64;

    #[inline(always)]
    fn index(&self, end: usize) -> &f64 {
        if end == 0 { &self.low } else { &self.high }
    }
}

impl IndexMut<usize> for Interval {
    #[inline(always)]
    fn index_mut(&mut self, end: usize) -> &mut f64 {
        if end == 0 { &mut self.low } else { &mut self.high }
    }
}

impl Add for Interval {
    type Output = Self;

    /// Adds every number of one interval to every number of the other.
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.low + other.low, self.high + other.high)
    }
}

impl Add<f64> for Interval {
    type Output = Self;

    /// Moves the interval.
    #[inline(always)]
    fn add(self, by: f64) -> Self {
        Self::new(self.low + by, self.high + by)
    }
}

impl Neg for Interval {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

impl Mul for Interval {
    type Output = Self;

    /// Multiplies every number of one interval by every number of the other.
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self, other);
        Self::around([a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high])
    }
}

impl Mul<f64> for Interval {
    type Output = Self;

    /// Multiplies every number of the interval.
    #[inline(always)]
    fn mul(self, by: f64) -> Self {
        Self::between(self.low * by, self.high * by)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_and_quotients_hold_those_of_all_numbers() {
        let all = [-3.0, -0.5, 0.0, 0.25, 2.0];
        let intervals =
            || all.into_iter().flat_map(|a| all.into_iter().map(move |b| Interval::between(a, b)));
        for (a, b) in intervals().flat_map(|a| intervals().map(move |b| (a, b))) {
            let product = a * b;
            for (p, q) in
                [0.0, 0.3, 1.0].into_iter().flat_map(|p| [0.0, 0.6, 1.0].map(|q| (a.at(p), b.at(q))))
            {
                assert!(product.grown(1e-15).contains(p * q), "{a:?} * {b:?} = {product:?}, not {}", p * q);
                assert!((a + -b).grown(1e-15).contains(p - q), "{a:?} - {b:?}");
                assert!(b.low <= 0.0 || a.quotient(b).grown(1e-14).contains(p / q), "{a:?} / {b:?}");
            }
            let ends = [a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high];
            assert!(
                ends.contains(&product.low) && ends.contains(&product.high),
                "{a:?} * {b:?} = {product:?}"
            );
        }
    }

    #[test]
    fn nothing_is_the_hull_of_nothing_and_nan_stays_nan() {
        let some = Interval::new(-1.0, 2.0);
        assert_eq!((Interval::NONE.hull(some), Interval::around([])), (some, Interval::NONE));
        assert!(Interval::NONE.is_empty() && !some.meets(Interval::NONE) && some.holds(Interval::NONE));
        assert_eq!([-7.0, 0.5, 9.0].map(|number| some.nearest(number)), [-1.0, 0.5, 2.0]);
        assert_eq!([0, 1, 2, 3].map(|k| some.step(k, 3)), [-1.0, 0.0, 1.0, 2.0]);
        assert_eq!([some.distance(Interval::of(2.5)), some.distance(Interval::of(0.0))], [0.5, 0.0]);
        assert!(some.surrounds(0.0) && !some.surrounds(2.0) && !Interval::of(0.0).has_width());
        assert!(
            some.overlaps(Interval::ALL)
                && some.meets(Interval::of(2.0))
                && !some.overlaps(Interval::of(0.0))
        );
        assert!(some.nearest(f64::NAN).is_nan() && !some.contains(f64::NAN));
        assert_eq!(serde_json::to_string(&some).unwrap(), "[-1.0,2.0]");
    }
}
