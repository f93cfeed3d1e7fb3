//! The curve of a polynomial segment in a frame.

use super::points::{self, repeated};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::{bernstein, derivative, exact_values, range, value};
use crate::numerics::twice::Twice;

/// A curve (ξ(t), ζ(t)). If the contact point is at t = 0, ζ has neither a constant nor a linear term; it then keeps its
/// digits down to C.
#[derive(Debug, Clone)]
pub struct PolynomialBranch {
    /// Coefficients of ξ(t).
    pub xi: Vec<f64>,
    /// Coefficients of ζ(t).
    pub zeta: Vec<f64>,
    /// Parameter range, ξ ascending with t.
    pub t: Interval,
    /// Range of ξ \[mm\].
    pub(super) ends: Interval,
    pub(super) exact: [Vec<Twice>; 2],
}

impl PolynomialBranch {
    /// Makes the branch of a whole segment from its coefficients in the frame.
    pub(super) fn new(exact: [Vec<Twice>; 2], t: Interval) -> Self {
        let [xi, zeta] = [&exact[0], &exact[1]].map(|c| c.iter().map(|c| c.high).collect::<Vec<_>>());
        let ends = t.map(|t| value(&xi, t));
        Self { xi, zeta, t, ends, exact }
    }

    /// Returns the coefficients of ξ(t) and of ζ(t).
    #[inline(always)]
    pub(super) fn coefficients(&self) -> [&[f64]; 2] {
        [&self.xi, &self.zeta]
    }

    /// Finds t with ξ(t) = ξ. If ξ is beyond the branch, t is that of the nearer end.
    pub fn parameter(&self, xi: f64) -> f64 {
        let (range, ends) = (repeated(self.t), repeated(self.ends));
        let guess = points::guess(range, ends, &[xi]);
        points::parameters(self.xi.as_slice(), range, &[xi], guess).map_or(f64::NAN, |[t]| t)
    }

    /// Finds the range of t over a range of ξ \[mm\].
    pub(super) fn parameters(&self, xi: Interval) -> Interval {
        xi.map(|xi| self.parameter(xi))
    }

    /// Refines t with ξ(t) = ξ from working precision to twice the working precision.
    #[inline(always)]
    pub(super) fn exact_parameters<const N: usize>(&self, xi: &Lanes<N>, t: &Lanes<N>) -> [Twice; N] {
        let mut exact = [Twice::ZERO; N];
        for k in 0..N {
            exact[k] = t[k].into();
        }
        let (abscissa, slope) = exact_values(&self.exact[0], &exact);
        for k in 0..N {
            // One more Newton step doubles the digits, whatever the rounding of its slope.
            let miss = abscissa[k] - xi[k];
            exact[k] = Twice::sum(t[k], -(miss.high / slope[k]));
        }
        exact
    }

    /// Returns bounds of ξ′(t) and ζ′(t) over an interval of ξ \[mm\], and of their quotient, which are infinite where ξ′ may be 0.
    pub(super) fn rates(&self, xi: Interval) -> ([Interval; 2], Interval) {
        self.rates_over(self.parameters(xi))
    }

    /// As [`Self::rates`] over an interval of t.
    ///
    /// Method: in Bernstein's form the quotient of two polynomials of one degree is a mean of those of their coefficients, if those of ξ′
    /// are all positive.
    fn rates_over(&self, t: Interval) -> ([Interval; 2], Interval) {
        let rates = [&self.xi, &self.zeta].map(|c| bernstein(&derivative(c), t));
        let bounds = [&rates[0], &rates[1]].map(|c| Interval::around(c.iter().copied()));
        let quotients = rates[0].iter().zip(&rates[1]).map(|(run, rise)| rise / run);
        (bounds, if bounds[0].low <= 0.0 { Interval::ALL } else { Interval::around(quotients) })
    }

    /// Returns bounds of ζ \[mm\] over an interval of ξ \[mm\].
    pub(super) fn height_bounds(&self, xi: Interval) -> Interval {
        range(&self.zeta, self.parameters(xi))
    }

    pub(super) fn derivative_bounds(&self, xi: Interval) -> [Interval; 2] {
        let t = self.parameters(xi);
        let ([run, rise], slope) = self.rates_over(t);
        if run.low <= 0.0 {
            return [slope; 2];
        }
        [slope, self.turn(t, [run, rise]).quotient(run.map(|v| v.powi(3)))]
    }

    /// Returns bounds of the curvature \[1/mm\] over an interval of ξ \[mm\]; infinite where both rates may be 0.
    pub(super) fn curvature_bounds(&self, xi: Interval) -> Interval {
        let t = self.parameters(xi);
        let (rates @ [run, rise], _) = self.rates_over(t);
        let slowest = run.nearest(0.0).hypot(rise.nearest(0.0));
        let speed = Interval::new(slowest, run.magnitude().hypot(rise.magnitude()));
        if slowest == 0.0 { Interval::ALL } else { self.turn(t, rates).quotient(speed.map(|v| v.powi(3))) }
    }

    /// Returns bounds of ζ″ξ′ − ξ″ζ′ over an interval of t from those of ξ′ and ζ′.
    fn turn(&self, t: Interval, [run, rise]: [Interval; 2]) -> Interval {
        let [bend, sag] = [&self.xi, &self.zeta].map(|c| range(&derivative(&derivative(c)), t));
        sag * run + -(bend * rise)
    }
}
