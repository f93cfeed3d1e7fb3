//! The second-order expansion of s at C, which Hertz's theory uses.

use crate::placement::{Body, Placement};
use crate::profile::{Section, Side};
use crate::separation::axis::EtaAxis;
use crate::separation::gap;
use crate::separation::kernel::Kernel;

/// The quadratic form s ≈ ½ κ_W ξ′² + ½ κ_η η′² − ½ κ_R ξ² + ½ κ_ρ η², with κ_η = cosθ/(R − z_C). κ_ρ is cosθ over the distance of
/// C from a roller's axle, and 0 for a rail. A body that varies has the second derivatives of its surface in place of its terms.
#[derive(Debug)]
pub struct Quadratic<'a> {
    arch: pulp::Arch,
    axis: &'a EtaAxis,
    /// Coefficients of ξ², ξη and η² \[1/mm\].
    form: [f64; 3],
}

impl<'a> Quadratic<'a> {
    /// Makes the quadratic form of a placed pair.
    pub fn new(placement: &Placement, axis: &'a EtaAxis) -> Self {
        Self { arch: pulp::Arch::new(), axis, form: quadratic_form(placement) }
    }
}

/// Computes the coefficients of ξ², ξη and η² \[1/mm\] in the second-order expansion of s at C.
///
/// At a joint the curvatures are those of the contact segments. The result is NaN if a body touches with a kink, or if the surface
/// of a body that varies has no second derivatives at C.
pub fn quadratic_form(placement: &Placement) -> [f64; 3] {
    if !(placement.rail().is_smooth() && placement.wheel().is_smooth()) {
        return [f64::NAN; 3];
    }
    let curvature = |section: &Section| section.branch_at(0.0).map_or(f64::NAN, |b| b.curvature(0.0));
    let curvatures = [curvature(&placement.rail().section), curvature(&placement.wheel().section)];
    let around = |body: &Body| body.section.frame.cos / body.axle_distance();
    let [along, mixed, across] = form(curvatures, around(placement.wheel()), placement.skew());
    if let Some(lofted) = placement.lofted() {
        let [xx, xy, yy] = lofted.bends().unwrap_or([f64::NAN; 3]);
        if lofted.side() == Side::Wheel {
            return [(xx - curvatures[0]) / 2.0, xy, yy / 2.0];
        }
        let [own, mixed, across] = form([0.0, curvatures[1]], around(placement.wheel()), placement.skew());
        return [own - xx / 2.0, mixed - xy, across - yy / 2.0];
    }
    let across = across + around(placement.rail()) / 2.0;
    match gap::relative_curvature(placement) {
        Some(relative) if placement.skew() == 0.0 => [relative / 2.0, mixed, across],
        _ => [along, mixed, across],
    }
}

/// Computes the coefficients of ξ², ξη and η² \[1/mm\] for a wheel on an extruded rail, from the curvatures of both profiles, `around`
/// = cosθ/(R − z_C) of the wheel, all in \[1/mm\], and the skew χ \[rad\].
pub fn form([k_r, k_w]: [f64; 2], around: f64, skew: f64) -> [f64; 3] {
    let (sin, cos) = skew.sin_cos();
    let along = k_w * cos * cos + around * sin * sin - k_r;
    [along / 2.0, (k_w - around) * sin * cos, (k_w * sin * sin + around * cos * cos) / 2.0]
}

impl Kernel for Quadratic<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        let [along, mixed, across] = self.form;
        let (constant, linear) = (along * xi * xi, mixed * xi);
        self.arch.dispatch(|| {
            for (s, eta) in out.iter_mut().zip(&self.axis.eta) {
                *s = constant + eta * (linear + across * eta);
            }
        });
    }
}
