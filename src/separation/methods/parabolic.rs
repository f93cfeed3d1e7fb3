//! Parabolas across the midplane, with one coefficient for all columns or one for each column.

use crate::separation::axis::EtaAxis;
use crate::separation::kernel::Kernel;
use crate::separation::relief::Relief;

/// The parabolas g(ξ) + η²/2R or g(ξ) + q(ξ, 0) η² of a relief. Under skew the wheel's ξ′ and η′ replace ξ and η. The parabola of
/// a column without a surface at η = 0 begins at η² = u_0, where the surface begins.
#[derive(Debug)]
pub struct Parabolic<'a> {
    arch: pulp::Arch,
    relief: Relief<'a>,
    axis: &'a EtaAxis,
    /// The coefficient 1/2R \[1/mm\]; `None` for q(ξ, 0).
    constant: Option<f64>,
}

impl<'a> Parabolic<'a> {
    /// Makes parabolas with the constant coefficient 1/2R of a cylinder of the nominal radius \[mm\].
    pub fn constant_radius(relief: Relief<'a>, radius: f64, axis: &'a EtaAxis) -> Self {
        Self { constant: Some(0.5 / radius), ..Self::local(relief, axis) }
    }

    /// Makes parabolas with the exact coefficient q(ξ, 0) at every ξ.
    pub fn local(relief: Relief<'a>, axis: &'a EtaAxis) -> Self {
        Self { arch: pulp::Arch::new(), relief, axis, constant: None }
    }
}

impl Kernel for Parabolic<'_> {
    fn column(&mut self, xi: f64, out: &mut [f64]) {
        if !self.relief.is_skewed() {
            let [u0, base, local] = self.relief.parabola(xi, 0.0, self.axis.reach * self.axis.reach);
            let q = self.constant.unwrap_or(local);
            let gap = base - q * u0;
            self.arch.dispatch(|| {
                for (s, u) in out.iter_mut().zip(self.axis.u.iter()) {
                    *s = gap + q * u;
                }
            });
            return;
        }
        for (s, &eta) in out.iter_mut().zip(&self.axis.eta) {
            let [shift, eta_w] = self.relief.skew.own(xi, eta);
            let u = eta_w * eta_w;
            let [u0, base, local] = self.relief.parabola(xi, shift, u);
            *s = base + self.constant.unwrap_or(local) * (u - u0);
        }
    }
}
