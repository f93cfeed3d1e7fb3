//! Fits parabolas by least squares, for tangents and curvatures of noisy points.

/// The parabola c₀ + c₁ s + c₂ s².
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::measured) struct Parabola([f64; 3]);

impl Parabola {
    /// Fits a parabola to (s, value) samples. At least three of them must have different s.
    ///
    /// Method: normal equations in s scaled to 1. Their condition is about 500, so that no digit above the noise is lost.
    pub fn fit(samples: impl Iterator<Item = (f64, f64)> + Clone) -> Self {
        let scale = samples.clone().map(|(s, _)| s.abs()).fold(0.0, f64::max);
        let (mut m, mut r) = ([0.0; 5], [0.0; 3]);
        for (s, value) in samples {
            let s = s / scale;
            let mut power = 1.0;
            for k in 0..5 {
                m[k] += power;
                if k < 3 {
                    r[k] += power * value;
                }
                power *= s;
            }
        }
        // The system is solved by Cramer's rule.
        let columns = [[m[0], m[1], m[2]], [m[1], m[2], m[3]], [m[2], m[3], m[4]]];
        let whole = determinant(columns);
        let unknown = |k: usize| {
            let mut replaced = columns;
            replaced[k] = r;
            determinant(replaced) / whole / scale.powi(k as i32)
        };
        Self([unknown(0), unknown(1), unknown(2)])
    }

    /// Returns the value at s.
    pub fn value(&self, s: f64) -> f64 {
        let [a, b, c] = self.0;
        a + s * (b + s * c)
    }

    /// Returns the slope at s.
    pub fn slope(&self, s: f64) -> f64 {
        let [_, b, c] = self.0;
        b + 2.0 * s * c
    }
}

fn determinant([a, b, c]: [[f64; 3]; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
        + c[0] * (a[1] * b[2] - a[2] * b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_comes_back() {
        let samples = [0.0, 0.1, 0.3, 2.0, 2.5].map(|s| (s, 3.0 - 2.0 * s + 0.5 * s * s));
        let fit = Parabola::fit(samples.into_iter());
        assert!((fit.value(-1.0) - 5.5).abs() < 1e-12 && (fit.slope(0.0) + 2.0).abs() < 1e-12, "{fit:?}");
    }
}
