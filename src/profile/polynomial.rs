//! Polynomial segments: the zones of a standard such as S1002, and the spans of a parametric spline.

use serde::{Deserialize, Serialize};

use super::station::Station;
use crate::error::{Error, Result, finite};
use crate::numerics::interval::Interval;
use crate::numerics::polynomial::{exact_coefficients, recentred};
use crate::numerics::twice::Twice;

/// A curve (x(t), z(t)) with polynomial coordinates. The coefficients are about a point of the curve itself and have twice
/// the working precision, because a standard's power form about x = 0 cancels from thousands of mm.
///
/// # Examples
/// ```
/// use wheelrail::Polynomial;
///
/// let parabola = Polynomial::graph(&[1.0, 0.0, 0.5], [-1.0, 2.0])?; // z = 1 + x²/2
/// let [_, end] = parabola.range().ends().map(|t| parabola.station(t));
/// assert_eq!((end.x, end.z), (2.0, 3.0));
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Polynomial {
    /// Range of the parameter, ascending \[mm or the spline's unit\].
    pub(crate) t: Interval,
    /// Coefficients of x(t) \[mm\].
    pub(crate) x: Vec<Twice>,
    /// Coefficients of z(t) \[mm\].
    pub(crate) z: Vec<Twice>,
}

impl Polynomial {
    /// Makes the curve z = Σ c_k x^k between two abscissae \[mm\], the form in which standards print it.
    ///
    /// # Errors
    /// No coefficient; values that are not finite; abscissae out of order.
    pub fn graph(c: &[f64], x: [f64; 2]) -> Result<Self> {
        for &v in c.iter().chain(&x) {
            finite("polynomial", v)?;
        }
        if c.is_empty() || x[0] >= x[1] {
            let found = format!("{} coefficients over [{}, {}]", c.len(), x[0], x[1]);
            let expected = "coefficients [c0, c1, …] and x = [x0, x1] with x0 < x1";
            return Err(Error::new("polynomial", found, expected, "correct the segment"));
        }
        let middle = x[0] + (x[1] - x[0]) / 2.0;
        let exact: Vec<Twice> = c.iter().map(|&c| c.into()).collect();
        Ok(Self {
            t: Interval::from(x).map(|x| x - middle),
            x: vec![middle.into(), 1.0.into()],
            z: recentred(&exact, middle.into()),
        })
    }

    /// Makes one span of a parametric spline: x = Σ x_k t^k, z = Σ z_k t^k over `t`.
    ///
    /// # Errors
    /// Values that are not finite, a parameter range out of order, or too few coefficients.
    pub fn span(x: &[f64], z: &[f64], t: [f64; 2]) -> Result<Self> {
        for &v in x.iter().chain(z).chain(&t) {
            finite("spline span", v)?;
        }
        if x.len() < 2 || z.is_empty() || t[0] >= t[1] {
            return Err(Error::new("spline span", "too few coefficients", "x, z and t0 < t1", "refit"));
        }
        let exact = |c: &[f64]| c.iter().map(|&c| c.into()).collect();
        Ok(Self { t: t.into(), x: exact(x), z: exact(z) })
    }

    /// Tells whether the curve has a range and enough coefficients.
    pub(super) fn is_sound(&self) -> bool {
        self.t.has_width() && self.x.len() >= 2 && !self.z.is_empty()
    }

    /// Returns the coefficients of x(t) and of z(t) \[mm\]. Each coefficient is a sum of two numbers: the rounded value and
    /// the rest.
    pub fn coefficients(&self) -> [Vec<[f64; 2]>; 2] {
        [&self.x, &self.z].map(|c| c.iter().map(|c| [c.high, c.low]).collect())
    }

    /// Returns \[dx/dt, dz/dt\] at parameter t.
    pub(super) fn rates(&self, t: f64) -> [f64; 2] {
        [&self.x, &self.z].map(|c| exact_coefficients(c, t.into())).map(|[_, rate]: [Twice; 2]| rate.into())
    }

    /// Returns the range of the parameter, ascending \[mm or the spline's unit\].
    pub fn range(&self) -> Interval {
        self.t
    }

    /// Returns the station at parameter t.
    pub fn station(&self, t: f64) -> Station {
        let [x, z] = [&self.x, &self.z].map(|c| exact_coefficients(c, t.into()).map(f64::from));
        station(x, z)
    }

    /// Returns the curvature \[1/mm\] at t, positive if the curve turns counter-clockwise.
    pub fn curvature(&self, t: f64) -> f64 {
        self.station_and_curvature(t).1
    }

    /// Returns the station at parameter t, and the curvature \[1/mm\] there.
    pub(super) fn station_and_curvature(&self, t: f64) -> (Station, f64) {
        let [[x, dx, hx], [z, dz, hz]] =
            [&self.x, &self.z].map(|c| exact_coefficients(c, t.into()).map(f64::from));
        (station([x, dx], [z, dz]), 2.0 * (dx * hz - dz * hx) / dx.hypot(dz).powi(3))
    }

    /// Returns the coefficients of x and z \[mm\] in powers of a parameter that goes from 0 to 1 between these shares of the range.
    pub(crate) fn over(&self, shares: Interval) -> [Vec<f64>; 2] {
        let unit = shares.width() * self.t.width();
        [&self.x, &self.z].map(|c| {
            let about = recentred(c, Twice::from(self.t.low + shares.low * self.t.width()));
            about.into_iter().zip(0..).map(|(c, power)| f64::from(c) * unit.powi(power)).collect()
        })
    }

    /// Returns the length per unit of the parameter at t.
    pub(super) fn speed(&self, t: f64) -> f64 {
        let [dx, dz] = self.rates(t);
        dx.hypot(dz)
    }

    /// Returns the curve plus a parabola that begins at t = `near`. To first order it adds `change` \[1/mm\] to the curvature, for
    /// the speed and direction that the curve has at t = `at`. It is along z for a graph z(x), so that the sum stays a graph;
    /// otherwise it is along the normal at `at`.
    pub(super) fn curved(&self, near: f64, at: f64, change: f64) -> Self {
        let [dx, dz] = self.rates(at);
        let speed = dx.hypot(dz);
        let [along_x, along_z] = if self.x.len() <= 2 { [0.0, 1.0] } else { [-dz / speed, dx / speed] };
        let half = 0.5 * change * speed.powi(3) / (along_z * dx - along_x * dz);
        let near = Twice::from(near);
        let parabola = [near * near * half, near * (-2.0 * half), Twice::from(half)];
        let plus = |c: &[Twice], share: f64| -> Vec<Twice> {
            let mut out = c.to_vec();
            if share != 0.0 {
                out.resize(out.len().max(3), Twice::ZERO);
                out.iter_mut().zip(parabola).for_each(|(c, p)| *c += p * share);
            }
            out
        };
        Self { t: self.t, x: plus(&self.x, along_x), z: plus(&self.z, along_z) }
    }

    pub(super) fn mirrored(&self) -> Self {
        let flip = |c: &[Twice], sign: f64| {
            c.iter().enumerate().map(|(k, &c)| c * if k % 2 == 1 { -sign } else { sign }).collect()
        };
        Self { t: -self.t, x: flip(&self.x, -1.0), z: flip(&self.z, 1.0) }
    }

    pub(super) fn upside_down(&self) -> Self {
        Self { z: self.z.iter().map(|&c| -c).collect(), ..self.clone() }
    }

    pub(super) fn placed_by(&self, frame: &Station) -> Self {
        let [mut x, mut z] = turned([&self.x, &self.z], [0.0; 2], frame.cos, -frame.sin);
        x[0] += frame.x;
        z[0] += frame.z;
        Self { t: self.t, x, z }
    }
}

/// Returns the station at a point with these rates.
fn station([x, dx]: [f64; 2], [z, dz]: [f64; 2]) -> Station {
    let norm = dx.hypot(dz);
    Station { x, z, cos: dx / norm, sin: dz / norm }
}

/// Turns the curve (x(t), z(t)) less the point `about` into (x cos + z sin, z cos − x sin), coefficient by coefficient.
pub(super) fn turned(
    c: [&[Twice]; 2],
    about: [f64; 2],
    cos: impl Into<Twice>,
    sin: impl Into<Twice>,
) -> [Vec<Twice>; 2] {
    let (cos, sin) = (cos.into(), sin.into());
    let get = |axis: usize, k: usize| {
        let own = c[axis].get(k).copied().unwrap_or(Twice::ZERO);
        if k == 0 { own - about[axis] } else { own }
    };
    let both = (0..c[0].len().max(c[1].len())).map(|k| [get(0, k), get(1, k)]);
    both.map(|[x, z]| (x * cos + z * sin, z * cos - x * sin)).unzip::<_, _, Vec<_>, Vec<_>>().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_s1002_throat_keeps_its_digits() -> Result<()> {
        let c = [
            4320.221063,
            1038.384026,
            106.5501873,
            6.051367875,
            0.2054332446,
            0.004169739389,
            4.687195829e-05,
            2.25275554e-07,
        ];
        let throat = Polynomial::graph(&c, [-35.0, -26.0])?;
        // 60-digit value of the same binary coefficients at x = −35.
        assert_eq!(throat.station(throat.t[0]).z, -6.867_385_429_697_391);
        Ok(())
    }

    #[test]
    fn curvature_of_a_parabola() -> Result<()> {
        let parabola = Polynomial::graph(&[0.0, 0.0, 0.5], [-1.0, 3.0])?;
        assert!((parabola.curvature(-1.0) - 1.0).abs() < 1e-15);
        let turned = parabola.placed_by(&Station { x: 5.0, z: 1.0, cos: 0.6, sin: 0.8 });
        assert!((turned.curvature(-1.0) - 1.0).abs() < 1e-15);
        assert!((parabola.mirrored().curvature(1.0) - 1.0).abs() < 1e-15);
        Ok(())
    }
}
