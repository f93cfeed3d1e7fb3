//! What s is held to, and what counts as rounding.

/// Share of a quantity that counts as rounding: more coefficients would not lower its error.
pub(super) const ROUNDING_LEVEL: f64 = 4.0 * f64::EPSILON;

/// Share of the absolute demand that truncation may use up. Rounding, and what lies between the samples of a plan, need the rest.
const TRUNCATION: f64 = 0.5;

/// A span below this share of its column's u, such as the closing of a drawing, starts with two coefficients.
const SHORT_SPAN: f64 = 0.01;

/// At this tolerance \[mm\] and below, the relative accuracy near C is kept as well.
///
/// s falls below any absolute tolerance near C; someone who asks for 1e-12 mm asks for all digits.
pub const FULL_PRECISION: f64 = 1e-12;

/// Relative truncation allowed at full precision: a fiftieth of the promised 1e-13, some roundings.
const FULL_RELATIVE: f64 = 2e-15;

/// The demand on s: |error| ≤ `absolute`, and |error| ≤ `relative` × |(u − u_0) q|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Largest absolute error of s \[mm\], such as 1e-12.
    pub absolute: f64,
    /// Largest error as a share of the wheel's rise above the beginning of the span; infinite where it does not matter.
    pub relative: f64,
}

impl Demand {
    /// Gives the demand on s for a tolerance \[mm\].
    pub fn for_tolerance(tolerance: f64) -> Self {
        let relative = if tolerance <= FULL_PRECISION { FULL_RELATIVE } else { f64::INFINITY };
        Self { absolute: tolerance, relative }
    }

    /// Gives the demand on truncation alone.
    pub(super) fn on_truncation(self) -> Self {
        Self { absolute: TRUNCATION * self.absolute, ..self }
    }

    /// Gives the error \[mm\] that a span may have whose end is `rise` \[mm\] above its beginning; never less than rounding. The
    /// sagitta \[mm\] of the beginning counts as well, because the rise of a short span is the difference of larger sagittae.
    #[inline(always)]
    pub(super) fn allowed(&self, rise: f64, sagitta: f64) -> f64 {
        let rise = rise.abs();
        self.absolute.min(self.relative * rise).max(ROUNDING_LEVEL * (rise + sagitta))
    }
}

/// Gives the number of coefficients to start with over a span of this length of u \[mm²\]: mostly `least`.
pub(super) fn first_count(least: usize, length: f64, u_max: f64) -> usize {
    if length <= SHORT_SPAN * u_max { least.min(2) } else { least }
}
