//! A profile that keeps its shape while its height varies along y: closed forms, and cubics that approximate and bound them.
//!
//! The height of a point z of the profile is z + d(y), or where its circle about the axle varies in proportion z + (1 + z/R) d(y).

use std::sync::Arc;

use super::bicubic::{Bicubic, SurfacePoint, hermite};
use super::tree::tree;
use crate::numerics::interval::Interval;
use crate::profile::{Mark, Profile, Shape, trace};

/// Largest cell across \[mm\]: its cubic is off by 0.1 nm on a 13 mm radius.
const CELL: f64 = 0.5;

/// Least kink \[rad\] at which a profile is divided. Across smaller ones Newton's method may not settle; it then ends within 1 nm.
const LEAST_KINK: f64 = 1e-6;

/// Least step \[mm\] at which a profile is divided.
const LEAST_STEP: f64 = 1e-6;

/// Factor that makes the largest error of a cell's cubic at three places inside the cell a bound over all of it.
const SURE: f64 = 2.0;

/// A part of a profile without kinks, divided into cells.
#[derive(Debug, Clone)]
pub(super) struct SmoothCurve {
    profile: Arc<Profile>,
    cells: Vec<CurveCell>,
    /// Bounds of x and z over the cells: see [`tree`].
    pub tree: Vec<[Interval; 2]>,
    /// Bound of the error of the cells' cubics \[mm\].
    off: f64,
}

/// A cell: a range of one segment's shares, with point and derivative at its ends.
#[derive(Debug, Clone)]
struct CurveCell {
    segment: usize,
    shares: Interval,
    /// Coefficients of x and z in powers of the share of the cell, on a polynomial; none on an arc or a line.
    powers: Option<[Vec<f64>; 2]>,
    ends: [[[f64; 2]; 2]; 2],
}

/// How the height varies over a stretch of y.
#[derive(Debug, Clone)]
pub(super) struct HeightStretch {
    form: HeightForm,
    /// Growth g of the displacement with the height z of a profile's point \[1/mm\]: a height d moves the point by (1 + g z) d.
    growth: f64,
    /// Ends of its cells \[mm\].
    pub at: Vec<f64>,
    /// Height \[mm\] and slope at these ends.
    rows: Vec<[f64; 2]>,
    /// Bound of the error of the cubics between these rows \[mm\].
    off: f64,
}

/// The closed form of a height; its angles are y over the radius.
#[derive(Debug, Clone, Copy)]
pub(super) enum HeightForm {
    /// Cubics between the rows.
    Cubics,
    /// A chord of a circle of this radius, at a distance from its centre \[mm\], and the angle of its middle.
    Chord { radius: f64, distance: f64, middle: f64 },
    /// A circle of `edge_radius` inside one of `radius`; its centre lies at a distance \[mm\] and an angle from that of the larger one.
    Edge { radius: f64, edge_radius: f64, distance: f64, middle: f64 },
}

impl SmoothCurve {
    /// Divides a profile at its kinks and steps.
    pub fn parts(profile: &Profile) -> Vec<Arc<Self>> {
        let (marks, profile) = (trace(profile, CELL), Arc::new(profile.clone()));
        let ends = |pair: &[Mark]| {
            let (a, b) = (&pair[0].station, &pair[1].station);
            let kink = b.seen_from(a).angle().abs();
            pair[0].segment != pair[1].segment
                && (kink > LEAST_KINK || (b.x - a.x).hypot(b.z - a.z) > LEAST_STEP)
        };
        let breaks = (1..marks.len()).filter(|&k| ends(&marks[k - 1..=k]));
        let breaks: Vec<usize> = [0].into_iter().chain(breaks).chain([marks.len()]).collect();
        breaks.windows(2).map(|pair| Arc::new(Self::new(&profile, &marks[pair[0]..pair[1]]))).collect()
    }

    fn new(profile: &Arc<Profile>, marks: &[Mark]) -> Self {
        let (mut cells, mut off) = (Vec::new(), 0.0_f64);
        for run in marks.chunk_by(|a, b| a.segment == b.segment) {
            let segment = run[0].segment;
            let count = (run.len() - 1) as f64;
            for k in 1..run.len() {
                let shares = Interval::new((k - 1) as f64 / count, k as f64 / count);
                let ends = shares.ends().map(|share| {
                    let [at, rate, _] = profile.segments()[segment].at_share(share);
                    [at, rate.map(|rate| rate / count)]
                });
                let powers = match &profile.segments()[segment].shape {
                    Shape::Polynomial(polynomial) => Some(polynomial.over(shares)),
                    Shape::Arc(_) => None,
                };
                let cell = CurveCell { segment, shares, powers, ends };
                for f in INSIDE {
                    let ([exact, ..], [near, ..]) = (cell.point(profile, f), cell.near(f));
                    off = off.max((exact[0] - near[0]).abs()).max((exact[1] - near[1]).abs());
                }
                cells.push(cell);
            }
        }
        let bounds =
            cells.iter().map(|cell| [0, 1].map(|axis| hull(cell.ends.map(|end| end.map(|v| v[axis])))));
        Self { profile: Arc::clone(profile), tree: tree(bounds), cells, off: SURE * off }
    }

    /// Gives the number of cells.
    pub fn cells(&self) -> usize {
        self.cells.len()
    }
}

/// Shares of a cell at which its cubic is compared.
const INSIDE: [f64; 3] = [0.25, 0.5, 0.75];

/// Bounds a cubic over one unit, given its values and slopes \[value, slope\] at both ends.
fn hull([[a, from], [b, to]]: [[f64; 2]; 2]) -> Interval {
    Interval::around([a, a + from / 3.0, b, b - to / 3.0])
}

/// Computes value and first two derivatives, at a share of a step, of the cubic with these values and slopes at the step's ends.
fn cubic(share: f64, step: f64, [[a, from], [b, to]]: [[f64; 2]; 2]) -> [f64; 3] {
    let h = hermite(share);
    [0, 1, 2].map(|k| {
        (h[k][0] * a + h[k][1] * step * from + h[k][2] * b + h[k][3] * step * to) / step.powi(k as i32)
    })
}

/// Computes Σ c_k f^k and its first two derivatives.
fn value_and_derivatives(c: &[f64], f: f64) -> [f64; 3] {
    let [value, rate, half] = c
        .iter()
        .rev()
        .fold([0.0; 3], |[value, rate, half], &c| [value * f + c, rate * f + value, half * f + rate]);
    [value, rate, 2.0 * half]
}

impl CurveCell {
    /// Computes the point and its first two derivatives at a share of the cell.
    fn point(&self, profile: &Profile, f: f64) -> [[f64; 2]; 3] {
        if let Some(powers) = &self.powers {
            let axes = powers.each_ref().map(|c| value_and_derivatives(c, f));
            return [0, 1, 2].map(|k| axes.map(|values| values[k]));
        }
        let width = self.shares.width();
        let [at, rate, bend] = profile.segments()[self.segment].at_share(self.shares.at(f));
        [at, rate.map(|v| v * width), bend.map(|v| v * width * width)]
    }

    /// Computes the point of the cell's cubic and its first two derivatives at a share of the cell.
    fn near(&self, f: f64) -> [[f64; 2]; 3] {
        let axes = [0, 1].map(|axis| cubic(f, 1.0, self.ends.map(|end| end.map(|v| v[axis]))));
        [0, 1, 2].map(|k| axes.map(|values| values[k]))
    }
}

impl HeightStretch {
    /// Makes a stretch of a closed form of a circle's radius over cells that end at these places \[mm\]; all circles of the profile vary in
    /// proportion.
    pub fn of_form(form: HeightForm, at: Vec<f64>) -> Self {
        let rows = at.iter().map(|y| form.height(*y)).map(|[value, slope, _]| [value, slope]).collect();
        let mut stretch = Self { form, growth: form.growth(), at, rows, off: 0.0 };
        let errors = (1..stretch.at.len()).flat_map(|k| {
            let (stretch, cell) = (&stretch, Interval::new(stretch.at[k - 1], stretch.at[k]));
            INSIDE.map(|f| {
                let y = cell.at(f);
                (stretch.near(k - 1, y)[0] - form.height(y)[0]).abs()
            })
        });
        stretch.off = SURE * errors.fold(0.0, f64::max);
        stretch
    }

    /// Makes a stretch of cubics through heights \[mm\] with slopes, at ascending places \[mm\]; the whole profile moves alike.
    pub fn of_cubics(at: Vec<f64>, rows: Vec<[f64; 2]>) -> Self {
        Self { form: HeightForm::Cubics, growth: 0.0, at, rows, off: 0.0 }
    }

    /// Computes height, slope and second derivative in a cell at y \[mm\].
    fn height(&self, cell: usize, y: f64) -> [f64; 3] {
        match self.form {
            HeightForm::Cubics => self.near(cell, y),
            form => form.height(y),
        }
    }

    /// Computes height, slope and second derivative of the cell's cubic at y \[mm\].
    fn near(&self, cell: usize, y: f64) -> [f64; 3] {
        let step = self.at[cell + 1] - self.at[cell];
        cubic((y - self.at[cell]) / step, step, [self.rows[cell], self.rows[cell + 1]])
    }

    /// Bounds the height of the cubic over a cell \[mm\].
    pub fn bounds(&self, cell: usize) -> Interval {
        let step = self.at[cell + 1] - self.at[cell];
        hull([0, 1].map(|k| [self.rows[cell + k][0], step * self.rows[cell + k][1]]))
    }
}

impl HeightForm {
    fn growth(&self) -> f64 {
        match self {
            Self::Cubics => 0.0,
            Self::Chord { radius, .. } | Self::Edge { radius, .. } => radius.recip(),
        }
    }

    /// Computes height, slope and second derivative at y \[mm\].
    fn height(&self, y: f64) -> [f64; 3] {
        match *self {
            Self::Cubics => [0.0; 3],
            Self::Chord { radius, distance, middle } => {
                let (sin, cos) = (y / radius - middle).sin_cos();
                let far = distance / cos;
                let slope = far * sin / cos / radius;
                [far - radius, slope, far * (1.0 + sin * sin) / (cos * cos * radius * radius)]
            }
            Self::Edge { radius, edge_radius, distance, middle } => {
                let (sin, cos) = (y / radius - middle).sin_cos();
                let (across, ahead) = (distance * sin, distance * cos);
                let leg = ((edge_radius - across) * (edge_radius + across)).sqrt();
                let far = ahead + leg;
                let tilt = across / leg;
                let bend = far * (tilt * tilt - (1.0 + tilt * tilt) * ahead / leg);
                [far - radius, -far * tilt / radius, bend / (radius * radius)]
            }
        }
    }
}

/// The surface of a curve over a stretch.
#[derive(Debug, Clone)]
pub(super) struct KeptSurface {
    pub curve: Arc<SmoothCurve>,
    pub stretch: HeightStretch,
}

impl KeptSurface {
    /// Computes the point at a share of a cell across, and at y \[mm\] in a bay.
    pub fn point(&self, bay: usize, cell: usize, f: f64, y: f64) -> SurfacePoint {
        let [at, across, across2] = self.curve.cells[cell].point(&self.curve.profile, f);
        let [height, slope, bend] = self.stretch.height(bay, y);
        let growth = self.stretch.growth;
        let (share, whole) = (1.0 + growth * height, 1.0 + growth * at[1]);
        SurfacePoint {
            y,
            at: [at[0], at[1] + whole * height],
            across: [across[0], share * across[1]],
            along: [0.0, whole * slope],
            across2: [across2[0], share * across2[1]],
            mixed: [0.0, growth * slope * across[1]],
            along2: [0.0, whole * bend],
        }
    }

    /// Makes the bicubic that approximates a cell.
    pub fn cell(&self, bay: usize, cell: usize) -> Bicubic {
        let HeightStretch { at, rows, growth, .. } = &self.stretch;
        let ends = &self.curve.cells[cell].ends;
        let corner = |a: usize, b: usize| {
            let ([[x, z], [xu, zu]], [height, slope]) = (ends[a], rows[bay + b]);
            let (share, whole) = (1.0 + growth * height, 1.0 + growth * z);
            [[x, z + whole * height], [xu, share * zu], [0.0, whole * slope], [0.0, growth * slope * zu]]
        };
        let corners = [0, 1].map(|a| [0, 1].map(|b| corner(a, b)));
        Bicubic { corners, y: Interval::new(at[bay], at[bay + 1]) }
    }

    /// Bounds x and z of the bicubics over a node of the curve's tree \[mm\].
    pub fn bounds(&self, bay: usize, node: usize) -> [Interval; 2] {
        let ([x, z], height) = (self.curve.tree[node], self.stretch.bounds(bay));
        [x, z * height.map(|height| 1.0 + self.stretch.growth * height) + height]
    }

    /// Bounds the error of the bicubics \[mm\].
    pub fn off(&self) -> f64 {
        let [_, z] = self.curve.tree[1];
        self.curve.off + self.stretch.off * (1.0 + self.stretch.growth * z.magnitude())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms_have_the_derivatives_of_their_differences() {
        let (radius, middle) = (460.0, 0.3);
        for form in [
            HeightForm::Chord { radius, distance: 459.0, middle },
            HeightForm::Edge { radius, edge_radius: 40.0, distance: 420.0, middle },
        ] {
            for y in [130.0, 138.0, 144.0] {
                let step = 1e-2;
                let [before, at, after] = [y - step, y, y + step].map(|y| form.height(y));
                for k in 0..2 {
                    let slope = (after[k] - before[k]) / (2.0 * step);
                    assert!((slope - at[k + 1]).abs() < 1e-8, "{form:?} {y}: {slope} {at:?}");
                }
            }
        }
    }
}
