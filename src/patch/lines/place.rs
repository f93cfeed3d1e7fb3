//! The least gap on one line.

use crate::numerics::interval::Interval;

/// A line, and the least gap on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct LowestPlace {
    /// ξ or σ \[mm\].
    pub(super) xi: f64,
    /// η of the least gap \[mm\], or of one far above δ.
    pub(super) eta: f64,
    /// Bounds of the least gap inside the window, less δ \[mm\]; the upper one is that at η. NaN where a body is missing.
    pub(super) depth: Interval,
}

impl LowestPlace {
    /// Whether a body is missing.
    pub(super) fn is_missing(&self) -> bool {
        self.depth.high.is_nan()
    }

    pub(super) fn is_inside(&self) -> bool {
        self.depth.high < 0.0
    }
}
