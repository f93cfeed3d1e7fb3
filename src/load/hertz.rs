//! Hertz's elliptic contact: curvatures at C, semi-axes, and the approach under a load.

use serde::Serialize;

use crate::numerics::elliptic::complete;
use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::search::Contact;
use crate::separation::methods::quadratic::{form, quadratic_form};

/// Elastic constants of one body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus \[N/mm²\].
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
}

impl Elastic {
    /// Steel: E = 210,000 N/mm², ν = 0.28.
    pub const STEEL: Self = Self { youngs_modulus: 210_000.0, poissons_ratio: 0.28 };

    /// Gives G = E / (2 (1 + ν)) \[N/mm²\].
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }
}

/// Gives the effective modulus E* \[N/mm²\]: 1/E* = (1 − ν_R²)/E_R + (1 − ν_W²)/E_W.
pub fn effective_modulus(rail: &Elastic, wheel: &Elastic) -> f64 {
    let compliance = |body: &Elastic| (1.0 - body.poissons_ratio * body.poissons_ratio) / body.youngs_modulus;
    (compliance(rail) + compliance(wheel)).recip()
}

/// The quadratic separation s = A x² + B y² in its principal directions, A ≤ B.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Curvatures {
    /// A \[1/mm\], along the ellipse's long axis: half the relative curvature.
    pub a_per_mm: f64,
    /// B \[1/mm\], along the ellipse's short axis: half the relative curvature.
    pub b_per_mm: f64,
    /// Angle of the long axis from ξ towards η \[rad\], in (−π/2, π/2\].
    pub long_axis_rad: f64,
}

/// Hertz's contact ellipse, with its approach, load and largest pressure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ellipse {
    /// Long semi-axis a \[mm\].
    pub a_mm: f64,
    /// Short semi-axis b \[mm\].
    pub b_mm: f64,
    /// Approach δ \[mm\].
    pub approach_mm: f64,
    /// Normal load \[N\].
    pub load_n: f64,
    /// Largest pressure p₀ \[N/mm²\].
    pub pressure_n_per_mm2: f64,
}

/// Computes the principal curvatures of s at C; not numbers where a body touches with a kink.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::load::{Elastic, curvatures, effective_modulus};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let curvatures = curvatures(&placement);
/// assert!((curvatures.a_per_mm * 920.0 - 1.0).abs() < 1e-12 && (curvatures.b_per_mm * 600.0 - 1.0).abs() < 1e-12);
///
/// let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
/// assert!((modulus - 113_932.3).abs() < 0.1);
/// let ellipse = curvatures.under_load(80_000.0, modulus).expect("a convex gap");
/// assert!((ellipse.approach_mm - 0.090_487_9).abs() < 1e-6);
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn curvatures(placement: &Placement) -> Curvatures {
    principal(quadratic_form(placement))
}

/// Computes the principal curvatures of s at a place that a search found on a rail or roller; not numbers at a kink. Curvatures along a
/// body that varies are not included: place the contact on it, and take [`curvatures`].
pub fn curvatures_at(contact: &Contact) -> Curvatures {
    principal(quadratic_form_at(contact))
}

/// Computes the coefficients \[1/mm\] of ξ², ξη and η² in the second-order expansion of s at a place that a search found on a rail or
/// roller of one profile; not numbers at a kink.
pub fn quadratic_form_at(contact: &Contact) -> [f64; 3] {
    let around = contact.wheel_angle.cos() / contact.rolling_radius;
    let [along, mixed, across] =
        form([contact.rail_curvature, contact.wheel_curvature], around, contact.skew);
    [along, mixed, across + contact.roller_curvature / 2.0]
}

/// Turns s = xx ξ² + xy ξη + yy η² into its principal directions.
fn principal([xx, xy, yy]: [f64; 3]) -> Curvatures {
    let (mean, half) = ((xx + yy) / 2.0, (xx - yy) / 2.0);
    let spread = half.hypot(xy / 2.0);
    // The smaller eigenvalue from the determinant, where the plain difference would cancel.
    let larger = mean + spread;
    let smaller = if mean > 0.0 { (xx * yy - xy * xy / 4.0) / larger } else { mean - spread };
    let long_axis_rad = if xy == 0.0 {
        if xx <= yy { 0.0 } else { std::f64::consts::FRAC_PI_2 }
    } else {
        (-xy / 2.0).atan2(spread - half).rem_euclid(std::f64::consts::PI)
    };
    let long_axis_rad = if long_axis_rad > std::f64::consts::FRAC_PI_2 {
        long_axis_rad - std::f64::consts::PI
    } else {
        long_axis_rad
    };
    Curvatures { a_per_mm: smaller, b_per_mm: larger, long_axis_rad }
}

impl Curvatures {
    /// Gives the semi-axes \[mm\] of an ellipse of these curvatures nearest to ξ and to η.
    pub fn along(&self, ellipse: &Ellipse) -> [f64; 2] {
        let Ellipse { a_mm, b_mm, .. } = *ellipse;
        if self.long_axis_rad.abs() < std::f64::consts::FRAC_PI_4 { [a_mm, b_mm] } else { [b_mm, a_mm] }
    }

    /// Finds k = b/a of the contact ellipse: A/B = k² D/(K − D), monotone in k. `None` where s is not convex at C
    /// (A ≤ 0), where Hertz has no ellipse.
    fn axis_ratio(&self) -> Option<f64> {
        let ratio = self.a_per_mm / self.b_per_mm;
        if ratio.is_nan() || ratio <= 0.0 || self.b_per_mm <= 0.0 {
            return None;
        }
        let miss = |ln_k: f64| {
            let k = ln_k.exp();
            let [big_k, d] = complete(k);
            (k * k * d / (big_k - d)).ln() - ratio.ln()
        };
        if ratio >= 1.0 {
            return Some(1.0);
        }
        // A/B ≤ k ≤ 1.
        bracketed(miss, ratio.ln(), 0.0).map(f64::exp)
    }

    /// Computes the ellipse under an approach δ \[mm\] for E* \[N/mm²\]; `None` where s is not convex at C, and without an approach.
    pub fn under_approach(&self, approach: f64, modulus: f64) -> Option<Ellipse> {
        let k = self.axis_ratio()?;
        let [big_k, d] = complete(k);
        // δ = (p₀b/E*) K and A = (p₀b/E*) D/a².
        let a = (approach * d / (big_k * self.a_per_mm)).sqrt();
        let b = k * a;
        let pressure = approach * modulus / (big_k * b);
        let load = 2.0 / 3.0 * pressure * std::f64::consts::PI * a * b;
        Some(Ellipse { a_mm: a, b_mm: b, approach_mm: approach, load_n: load, pressure_n_per_mm2: pressure })
            .filter(|_| approach > 0.0)
    }

    /// Computes the ellipse under a normal load \[N\] for E* \[N/mm²\]; `None` where s is not convex at C, and without a load.
    pub fn under_load(&self, load: f64, modulus: f64) -> Option<Ellipse> {
        let k = self.axis_ratio()?;
        let [big_k, d] = complete(k);
        // P = (2/3)π p₀ab with p₀b = A a² E*/D.
        let a = (1.5 * load * d / (std::f64::consts::PI * modulus * self.a_per_mm)).cbrt();
        let approach = self.a_per_mm * a * a * big_k / d;
        self.under_approach(approach, modulus)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The Hertz case of the solvers' documentation: 460 mm wheel on a 300 mm rail crown, 80 kN.
    #[test]
    fn crossed_cylinders_of_460_and_300_mm() {
        let curvatures = Curvatures { a_per_mm: 0.5 / 460.0, b_per_mm: 0.5 / 300.0, long_axis_rad: 0.0 };
        let ellipse = curvatures.under_load(80e3, 113_932.0);
        assert!(ellipse.is_some_and(|e| (e.pressure_n_per_mm2 - 1139.19).abs() < 0.01), "{ellipse:?}");
        assert!(ellipse.is_some_and(|e| (e.approach_mm - 0.090_487_9).abs() < 1e-6), "{ellipse:?}");
    }

    #[test]
    fn a_sphere_has_a_circle_and_a_saddle_nothing() {
        let sphere = Curvatures { a_per_mm: 0.01, b_per_mm: 0.01, long_axis_rad: 0.0 };
        let circle = sphere.under_approach(0.02, 1e5);
        // a² = Rδ with R = 1/(2A).
        assert!(circle.is_some_and(|c| (c.a_mm - 1.0).abs() < 1e-12 && c.a_mm == c.b_mm), "{circle:?}");
        let saddle = Curvatures { a_per_mm: -0.01, ..sphere };
        assert_eq!(saddle.under_load(1e4, 1e5), None);
    }
}
