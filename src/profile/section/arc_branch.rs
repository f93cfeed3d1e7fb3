//! The curve of a line or an arc in a frame.

use crate::numerics::cosine;
use crate::numerics::lanes::Lanes;
use crate::numerics::twice::Twice;

/// A line or arc: ζ = ζ_a + Δξ (S_a + S)/(C_a + C) with S = S_a + κΔξ and C = √(1 − S²). The slope of a chord is the
/// tangent of its mean angle. Nothing cancels for any radius, and lines need no case of their own.
#[derive(Debug, Clone, Copy)]
pub struct ArcBranch {
    /// Anchor (ξ_a, ζ_a) \[mm\]: the contact point, or else the flattest point of the branch.
    pub anchor: [f64; 2],
    /// S_a, sine of the tangent angle at the anchor.
    pub sin: f64,
    /// C_a, cosine of the tangent angle at the anchor.
    pub cos: f64,
    /// Signed radius \[mm\], ∞ for a line.
    pub radius: f64,
    /// κ = 1/radius \[1/mm\], 0 for a line.
    pub curvature: f64,
}

impl ArcBranch {
    /// Returns (S, C) at ξ. A line has a C of its own, because √(1 − S²) is 0 to rounding for S = 1 − 1e-17.
    #[inline(always)]
    pub fn sine_cosine(&self, xi: f64) -> (f64, f64) {
        let sin = self.sin + self.curvature * (xi - self.anchor[0]);
        (sin, if self.curvature == 0.0 { self.cos } else { cosine(sin) })
    }

    /// Computes ζ(ξ) \[mm\].
    #[inline]
    pub fn height(&self, xi: f64) -> f64 {
        let (sin, cos) = self.sine_cosine(xi);
        self.height_of(xi, sin, cos)
    }

    #[inline(always)]
    pub(super) fn height_of(&self, xi: f64, sin: f64, cos: f64) -> f64 {
        self.anchor[1] + (xi - self.anchor[0]) * ((self.sin + sin) / (self.cos + cos))
    }

    /// Computes ζ and ξ along chords, as multiples of `runs`, from points with sines S and secants 1/C. A multiple of ξ is
    /// NaN if the chord may end beyond a vertical tangent.
    ///
    /// A chord over which the tangent turns by 2α has the length 2R sin α, and its angle to the tangent is α; tan α =
    /// runs/2RC.
    #[inline(always)]
    pub(super) fn chords_near<const N: usize>(
        &self,
        [sin, secant]: [&Lanes<N>; 2],
        runs: &Lanes<N>,
    ) -> [Lanes<N>; 2] {
        let [mut climb, mut stretch] = [[0.0; N]; 2];
        for k in 0..N {
            let slope = sin[k] * secant[k];
            let turn = 0.5 * self.curvature * (runs[k] * secant[k]);
            let square_cosine = 1.0 / (1.0 + turn * turn);
            climb[k] = (slope + turn) * square_cosine;
            stretch[k] = (1.0 - slope * turn) * square_cosine;
            // The tangent has turned by 2α.
            let upright = 1.0 - turn * (turn + 2.0 * slope) > 0.0;
            stretch[k] = if upright { stretch[k] } else { f64::NAN };
        }
        [climb, stretch]
    }

    #[inline(always)]
    pub(super) fn exact_heights<const N: usize>(&self, xi: &Lanes<N>) -> [Twice; N] {
        let one = Twice::from(1.0);
        let [xi_a, zeta_a] = self.anchor;
        let mut zeta = [Twice::ZERO; N];
        for (k, &xi) in xi.iter().enumerate() {
            let run = Twice::sum(xi, -xi_a);
            let turn = if self.radius.is_finite() { run / self.radius } else { Twice::ZERO };
            let sin = turn + self.sin;
            let cos = ((one - sin) * (one + sin)).sqrt();
            zeta[k] = run * (sin + self.sin) / (cos + self.cos) + zeta_a;
        }
        zeta
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chord_past_a_vertical_tangent_is_no_number() {
        // The lower half of a circle is tested from its lowest point, with tan α = 0.2 and 1.1.
        let arc = ArcBranch { anchor: [0.0; 2], sin: 0.0, cos: 1.0, radius: 1.0, curvature: 1.0 };
        let [climb, stretch] = arc.chords_near([&[0.0; 2], &[1.0; 2]], &[0.4, 2.2]);
        let [xi, zeta] = [0.4 * stretch[0], 0.4 * climb[0]];
        assert!((xi - 5.0 / 13.0).abs() < 1e-15 && (zeta - arc.height(xi)).abs() < 1e-15);
        assert!(stretch[1].is_nan());
    }
}
