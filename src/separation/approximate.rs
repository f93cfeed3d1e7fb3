//! The three approximations: quadratic, constant radius, parabolic.

use super::axis::EtaAxis;
use super::grid::Kernel;
use super::{Evaluator, gap};
use crate::placement::Placement;

/// Hertz: s ≈ ½ κ_W ξ′² + ½ κ_η η′² − ½ κ_R ξ², with κ_η = cosθ/(R − z_C).
#[derive(Debug)]
pub struct Quadratic<'a> {
    arch: pulp::Arch,
    axis: &'a EtaAxis,
    /// Coefficients of ξ², ξη, η².
    form: [f64; 3],
}

impl<'a> Quadratic<'a> {
    /// The quadratic form of a placed pair.
    pub fn new(placement: &Placement, axis: &'a EtaAxis) -> Self {
        Self { arch: pulp::Arch::new(), axis, form: quadratic_form(placement) }
    }
}

/// Coefficients of ξ², ξη and η² \[1/mm\] in the second-order expansion of s at C.
///
/// At a joint the curvatures are those of the contact segments; NaN where a body touches with a kink.
pub fn quadratic_form(placement: &Placement) -> [f64; 3] {
    if !(placement.rail.is_smooth() && placement.wheel.is_smooth()) {
        return [f64::NAN; 3];
    }
    let curvature =
        |section: &crate::profile::Section| section.branch_at(0.0).map_or(f64::NAN, |b| b.curvature(0.0));
    let curvatures = [curvature(&placement.rail.section), curvature(&placement.wheel.section)];
    let around = placement.wheel.section.frame.cos / placement.rolling_radius();
    let [along, mixed, across] = form(curvatures, around, placement.skew);
    match gap::relative_curvature(placement) {
        Some(relative) if placement.skew == 0.0 => [relative / 2.0, mixed, across],
        _ => [along, mixed, across],
    }
}

/// The same from the curvatures of rail and wheel profile, cosθ_W/ϱ \[1/mm\] and the skew χ \[rad\].
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

/// s ≈ g(ξ) + η²/2R, or without a constant coefficient g(ξ) + q(ξ, 0) η²; with skew g and η are the wheel's own.
#[derive(Debug)]
pub struct Parabolic<'a> {
    arch: pulp::Arch,
    evaluator: Evaluator<'a>,
    axis: &'a EtaAxis,
    /// 1/2R \[1/mm\], or `None` for the local q(ξ, 0).
    constant: Option<f64>,
}

impl<'a> Parabolic<'a> {
    /// With the constant coefficient 1/2R of a cylinder of the nominal radius.
    pub fn constant_radius(placement: &'a Placement, axis: &'a EtaAxis) -> Self {
        let constant = Some(0.5 / placement.wheel_radius);
        Self { constant, ..Self::local(placement, axis) }
    }

    /// With the exact coefficient q(ξ, 0) at every ξ.
    pub fn local(placement: &'a Placement, axis: &'a EtaAxis) -> Self {
        Self { arch: pulp::Arch::new(), evaluator: Evaluator::new(placement), axis, constant: None }
    }
}

impl Kernel for Parabolic<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        if self.evaluator.placement.skew == 0.0 {
            let [gap, local] = self.evaluator.parabola(xi, 0.0);
            let q = self.constant.unwrap_or(local);
            self.arch.dispatch(|| {
                for (s, u) in out.iter_mut().zip(self.axis.u.iter()) {
                    *s = gap + q * u;
                }
            });
            return;
        }
        for (s, &eta) in out.iter_mut().zip(&self.axis.eta) {
            let [shift, eta_w] = self.evaluator.wheel_coordinates(xi, eta);
            let [gap, local] = self.evaluator.parabola(xi, shift);
            *s = gap + self.constant.unwrap_or(local) * (eta_w * eta_w);
        }
    }
}
