//! The accuracy that s must have, and the size below which a quantity counts as rounding.

/// Share of a quantity below which a part of it counts as rounding. Further coefficients would not lower its error.
pub(crate) const ROUNDING_LEVEL: f64 = 4.0 * f64::EPSILON;

/// Share of the absolute demand that truncation may use. The rest is for rounding, and for places between the samples of a
/// plan.
const TRUNCATION: f64 = 0.5;

/// Length of a span, as a share of its column's u, below which it starts with two coefficients. The closing of a drawing
/// makes such spans.
const SHORT_SPAN: f64 = 0.01;

/// Tolerance \[mm\] at and below which the relative accuracy near C is kept, too.
///
/// Near C s falls below any absolute tolerance. A user who asks for 1e-12 mm wants all digits.
pub const FULL_PRECISION: f64 = 1e-12;

/// Relative truncation error that is allowed at full precision: a fiftieth of the promised 1e-13, a few roundings.
const FULL_RELATIVE: f64 = 2e-15;

/// The accuracy demanded of s: |error| ≤ `absolute`, and |error| ≤ `relative` × the wheel's rise above the beginning of the span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Largest absolute error of s \[mm\], such as 1e-12.
    pub absolute: f64,
    /// Largest error as a share of the wheel's rise above the beginning of the span; infinite if only `absolute` counts.
    pub relative: f64,
}

impl Demand {
    /// Returns the demand on s for a tolerance \[mm\].
    pub fn for_tolerance(tolerance: f64) -> Self {
        let relative = if tolerance <= FULL_PRECISION { FULL_RELATIVE } else { f64::INFINITY };
        Self { absolute: tolerance, relative }
    }

    /// Returns the demand on truncation alone.
    pub(crate) fn on_truncation(self) -> Self {
        Self { absolute: TRUNCATION * self.absolute, ..self }
    }

    /// Returns the error \[mm\] that is allowed in a span whose end is `rise` \[mm\] above its beginning; never less than
    /// rounding. The sagitta \[mm\] of the beginning counts as well, because the rise of a short span is the difference of
    /// larger sagittae.
    #[inline(always)]
    pub(crate) fn allowed(&self, rise: f64, sagitta: f64) -> f64 {
        let rise = rise.abs();
        self.absolute.min(self.relative * rise).max(ROUNDING_LEVEL * (rise + sagitta))
    }
}

/// Returns the number of coefficients to start with over a span whose u has this length \[mm²\]: `least`, or two for a
/// short span.
pub(super) fn first_count(least: usize, length: f64, u_max: f64) -> usize {
    if length <= SHORT_SPAN * u_max { least.min(2) } else { least }
}
