//! The Report's own INSEP: Newton–Raphson on (6.13), kept as the historical baseline.
//!
//! It follows the printed text, in centre form, with its cancellation: F = (z − R)² − (ρ² − η²) leaves an absolute error of
//! about 1e-13 mm whatever the size of s (erratum 7). The segment is found anew from x at every iterate (erratum 6). If the
//! iteration from the midplane leaves the profile or an arc, or does not settle, it begins anew at the point of the sagitta
//! form; if it does not settle there either, that point is the result.

use crate::numerics::interval::Interval;
use crate::numerics::polynomial::derivatives;
use crate::placement::Placement;
use crate::profile::{Segment, Shape, Station};
use crate::separation::axis::EtaAxis;
use crate::separation::evaluator::Evaluator;
use crate::separation::kernel::Kernel;

/// Most iterations before the Report's method counts as not convergent. It needs 2 to 5 if it converges.
const MOST_ITERATIONS: usize = 50;

/// A segment as (3.2) writes it.
#[derive(Debug, Clone)]
enum Printed {
    /// z = b ± √(R² − (x − a)²); the sign is stored because of erratum 2.
    Arc { a: f64, b: f64, radius: f64, sign: f64 },
    /// z = a x + b.
    Line { a: f64, b: f64 },
    /// z = Σ c_k (x − x_m)^k. The Report has no polynomials.
    Polynomial { middle: f64, c: Vec<f64> },
}

/// Names the feature of a placed pair for which the Report's method has no formula; its values are then NaN. Returns `None`
/// if it has formulas for everything.
pub fn missing(placement: &Placement) -> Option<&'static str> {
    if placement.skew() != 0.0 {
        return Some("yaw");
    }
    if placement.under().is_some() {
        return Some("a roller");
    }
    if let Some(varying) = placement.varying() {
        return Some(varying);
    }
    let segments = placement.wheel().profile().segments().iter();
    let unknown = |shape| Printed::of(shape, &Station::AXES).is_none();
    segments.map(|segment| &segment.shape).any(unknown).then_some("a wheel of parametric curves")
}

/// Newton's iteration on (6.13) at every point.
#[derive(Debug)]
pub struct ReportNewton<'a> {
    placement: &'a Placement,
    evaluator: Evaluator<'a>,
    axis: &'a EtaAxis,
    /// The rail's segments; `None` for polynomials, which (6.2) does not cover.
    rail: Vec<Option<Printed>>,
    wheel: Vec<(Interval, Printed)>,
    tolerance: f64,
    last: usize,
}

impl Printed {
    fn of(shape: &Shape, frame: &Station) -> Option<Self> {
        match shape {
            Shape::Arc(arc) => {
                let Some([x, z]) = arc.centre() else {
                    let start = arc.start.seen_from(frame);
                    let a = start.sin / start.cos;
                    return Some(Self::Line { a, b: start.z - a * start.x });
                };
                let centre = Station { x, z, ..Station::AXES }.seen_from(frame);
                let sign = if arc.radius < 0.0 { 1.0 } else { -1.0 };
                Some(Self::Arc { a: centre.x, b: centre.z, radius: arc.radius.abs(), sign })
            }
            Shape::Polynomial(p) if *frame == Station::AXES && p.x.len() == 2 => {
                let c = p.z.iter().map(|&c| c.into()).collect();
                Some(Self::Polynomial { middle: p.x[0].into(), c })
            }
            Shape::Polynomial(_) => None,
        }
    }

    /// Computes (z, dz/dx) at x.
    fn profile(&self, x: f64) -> (f64, f64) {
        match self {
            Self::Arc { a, b, radius, sign } => {
                let root = (radius * radius - (x - a) * (x - a)).sqrt();
                (b + sign * root, -sign * (x - a) / root)
            }
            Self::Line { a, b } => (a * x + b, *a),
            Self::Polynomial { middle, c } => {
                let [z, slope, _] = derivatives(c, x - middle);
                (z, slope)
            }
        }
    }
}

impl<'a> ReportNewton<'a> {
    /// Makes the method for a placed pair without skew. It iterates until |Δζ| is below `tolerance` \[mm\].
    pub fn new(placement: &'a Placement, axis: &'a EtaAxis, tolerance: f64) -> Self {
        let wheel = placement.wheel().profile().segments().iter();
        let over = |s: &Segment| Interval::new(s.start().x, s.end().x);
        let wheel = wheel.filter_map(|s| Some((over(s), Printed::of(&s.shape, &Station::AXES)?)));
        let (rail, frame) = (placement.rail().profile().segments(), placement.rail().section.frame);
        Self {
            placement,
            evaluator: Evaluator::new(placement),
            axis,
            rail: rail.iter().map(|segment| Printed::of(&segment.shape, &frame)).collect(),
            wheel: wheel.collect(),
            tolerance,
            last: 0,
        }
    }

    fn wheel_profile(&mut self, x: f64) -> Option<(f64, f64)> {
        let holds = |(xi, _): &(Interval, Printed)| xi.contains(x);
        if !self.wheel.get(self.last).is_some_and(holds) {
            self.last = self.wheel.iter().position(holds)?;
        }
        Some(self.wheel[self.last].1.profile(x))
    }

    /// Computes ζ^W \[mm\] by steps a to h of Sec. 6.2; `None` if they do not converge.
    fn wheel_height(&mut self, xi: f64, eta: f64, guess: f64) -> Option<f64> {
        let Station { x: x_c, z: z_c, cos, sin } = self.placement.wheel().section.frame;
        let radius = self.placement.wheel_radius();
        let mut zeta = guess;
        for _ in 0..MOST_ITERATIONS {
            let x = x_c + xi * cos - zeta * sin;
            let z = z_c + xi * sin + zeta * cos;
            let (profile, slope) = self.wheel_profile(x)?;
            let rho = radius - profile;
            let f = (z - radius) * (z - radius) - (rho * rho - eta * eta);
            // (6.16): ∂F/∂z ∂z/∂ζ + ∂F/∂ρ ∂ρ/∂x ∂x/∂ζ, with ∂ρ/∂x = −slope.
            let df = 2.0 * (z - radius) * cos + (-2.0 * rho) * -slope * -sin;
            let step = -f / df;
            zeta += step;
            if step.abs() <= self.tolerance {
                return Some(zeta);
            }
            if step.is_nan() {
                break;
            }
        }
        None
    }

    /// Computes ζ^R \[mm\]; NaN off the rail.
    fn rail_height(&self, xi: f64) -> f64 {
        let rail = &self.placement.rail().section;
        let Some(branch) = rail.branch_at(xi) else { return f64::NAN };
        let printed = self.rail[branch.segment].as_ref().map(|printed| printed.profile(xi).0);
        // The printed root is NaN where rounding takes ξ past an arc's side.
        printed.filter(|height| !height.is_nan()).unwrap_or_else(|| branch.height(xi))
    }
}

impl Kernel for ReportNewton<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        let rail = self.rail_height(xi);
        let guess = self.placement.wheel().section.height(xi);
        for (s, &eta) in out.iter_mut().zip(&self.axis.eta) {
            let height = self.wheel_height(xi, eta, guess).unwrap_or_else(|| {
                let start = self.evaluator.separation(xi, eta) + rail;
                self.wheel_height(xi, eta, start).unwrap_or(start)
            });
            *s = height - rail;
        }
    }
}
