//! Guaranteed bounds of a part of a profile, known before its points are looked at. Their width shrinks with
//! the square of the part's length.

use crate::numerics::cosine;
use crate::numerics::interval::Interval;
use crate::numerics::polynomial::{bernstein, convolution, derivative, range};
use crate::profile::{Side, Station};

/// Bounds of a part of a profile, in the profile's own axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// Least and largest abscissa \[mm\].
    pub x: Interval,
    /// Least and largest height \[mm\].
    pub z: Interval,
    /// Least and largest sine of the tangent angle.
    pub sine: Interval,
    /// Cosines of the tangent angles of `sine`.
    pub cosine: [f64; 2],
    /// Tangents of the tangent angles of `sine`, ±∞ for a vertical.
    pub tangent: Interval,
    /// Least and largest curvature \[1/mm\], positive with the hollow side up.
    pub curvature: Interval,
    /// Direction of the chord: \[cos, sin\].
    pub chord: [f64; 2],
    /// Level of the line along the chord that the other body would meet first \[mm\]: z cos − x sin of all
    /// points is at least this on a wheel, at most this on a rail.
    pub level: f64,
    /// The line of `level` as its height at x = 0 \[mm\] and slope. If it is too steep, a horizontal line
    /// through the lowest or highest point instead.
    pub line: [f64; 2],
}

/// Largest slope of a chord that bounds; a steeper one is replaced by the height. Along a steep line rounding
/// of an abscissa counts thirty times and more, and the ends lie at nearly one abscissa anyway.
pub(super) const STEEPEST_SLOPE: f64 = 32.0;

/// Bounds of the derivatives of a stretch with respect to its parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct DerivativeBounds {
    /// Largest |dx|.
    pub run: f64,
    /// Largest |dz|.
    pub rise: f64,
    /// Largest length of the second derivative.
    pub bend: f64,
    /// Least and largest sine of the tangent angle.
    pub sine: Interval,
    /// Least and largest curvature \[1/mm\].
    pub curvature: Interval,
    /// Largest derivative of the curvature.
    pub change: f64,
}

/// Returns the distance of a point from the line through the origin with direction `[cos, sin]`: z cos − x
/// sin.
#[inline]
fn level([cos, sin]: [f64; 2], [x, z]: [f64; 2]) -> f64 {
    z * cos - x * sin
}

impl Bounds {
    fn new(
        [x, z]: [Interval; 2],
        [sine, curvature]: [Interval; 2],
        (chord, level): ([f64; 2], f64),
        side: Side,
    ) -> Self {
        let sine = sine.map(|sin| sin.clamp(-1.0, 1.0));
        let cosine = sine.ends().map(cosine);
        let line = if chord[0] * STEEPEST_SLOPE >= 1.0 {
            [level / chord[0], chord[1] / chord[0]]
        } else {
            [if side == Side::Wheel { z.low } else { z.high }, 0.0]
        };
        let tangent = Interval::new(sine.low / cosine[0], sine.high / cosine[1]);
        Self { x, z, sine, cosine, tangent, curvature, chord, level, line }
    }

    /// Returns the bounds of a part that lies in the hull of some points, with these tangents and curvatures;
    /// `rounding` \[mm\] is that of the points.
    ///
    /// The chord goes from the left to the right of `ends`; if they are one point, it has the direction of
    /// the mean tangent.
    pub fn of_hull(
        hull: &[[f64; 2]],
        ends: [[f64; 2]; 2],
        [sine, curvature]: [Interval; 2],
        side: Side,
        rounding: f64,
    ) -> Self {
        let (run, rise) = (ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]);
        let length = run.hypot(rise);
        let chord = if length > 0.0 {
            [run / length, rise / length]
        } else {
            let angle = sine.map(|sin| sin.clamp(-1.0, 1.0).asin()).middle();
            [angle.cos(), angle.sin()]
        };
        let z = Interval::around(hull.iter().map(|point| point[1]));
        let levels = Interval::around(hull.iter().map(|point| level(chord, *point))).grown(rounding);
        let level = if side == Side::Wheel { levels.low } else { levels.high };
        let x = Interval::new(ends[0][0], ends[1][0]);
        Self::new([x, z.grown(rounding)], [sine, curvature], (chord, level), side)
    }

    /// Returns the bounds of an arc or fan between two points with ascending sines of their tangents, from a
    /// point between them.
    pub fn of_arc(
        ends: &[Station; 2],
        middle: &Station,
        curvature: Interval,
        side: Side,
        rounding: f64,
    ) -> Self {
        let [a, b] = ends;
        let turn = b.sin.clamp(-1.0, 1.0).asin() - a.sin.clamp(-1.0, 1.0).asin();
        let length = (b.x - a.x).hypot(b.z - a.z);
        // A chord of a turn t is off the arc by less than t/4 of its length, for turns up to half a circle.
        let off = 0.5 * length * turn + rounding;
        let chord = [middle.cos, middle.sin];
        let [first, last] = ends.map(|end| level(chord, [end.x, end.z]));
        let levels = Interval::of(first).with(last).grown(off);
        let level = if side == Side::Wheel { levels.low } else { levels.high };
        let (x, z) = (Interval::of(a.x).with(b.x), Interval::of(a.z).with(b.z).grown(off));
        Self::new([x, z], [Interval::new(a.sin, b.sin), curvature], (chord, level), side)
    }
}

impl DerivativeBounds {
    /// Returns the bounds over a range of the parameter, for a curve with coefficients \[x, z\].
    ///
    /// Method: Bernstein coefficients; the tangents lie in the cone of the control vectors. Unbounded where
    /// the curve may stand still.
    pub fn of(coefficients: &[[f64; 2]], t: Interval) -> Self {
        let [x, z] = [0, 1].map(|axis| coefficients.iter().map(|c| c[axis]).collect::<Vec<f64>>());
        let (dx, dz) = (derived(&x), derived(&z));
        let (hx, hz) = (derived(&dx), derived(&dz));
        let largest = |c: &[f64]| range(c, t).magnitude();
        let square = sum(&convolution(&dx, &dx), &convolution(&dz, &dz), 1.0);
        let cross = sum(&convolution(&dx, &hz), &convolution(&dz, &hx), -1.0);
        let speed = range(&square, t).map(|v| v.max(0.0).sqrt());
        let cubes = speed.map(|v| (v * v * v).recip());
        let turning = range(&cross, t);
        let over = |v: f64, up: bool| if (v > 0.0) == up { v * cubes[0] } else { v * cubes[1] };
        let bounded = speed[0] > 0.0;
        let curvature = if bounded {
            Interval::new(over(turning[0], false), over(turning[1], true))
        } else {
            Interval::ALL
        };
        let steepest = curvature.magnitude();
        let change = if bounded {
            largest(&derived(&cross)) * cubes[0]
                + 1.5 * steepest * largest(&derived(&square)) / speed[0].powi(2)
        } else {
            f64::INFINITY
        };
        Self {
            run: largest(&dx),
            rise: largest(&dz),
            bend: largest(&hx).hypot(largest(&hz)),
            sine: cone(&bernstein(&dx, t), &bernstein(&dz, t)),
            curvature,
            change,
        }
    }

    /// Returns whether the bounds are too wide to decide most pairs at once: see [`WIDEST_TURN`],
    /// [`VARIATION`].
    pub fn is_wide(&self, width: f64) -> bool {
        let most = self.curvature.magnitude();
        let turn = most * width * self.run.hypot(self.rise);
        let varies = self.curvature.width() > VARIATION * most;
        turn.is_nan() || turn > WIDEST_TURN || (varies && turn > LEAST_TURN)
    }

    /// Returns the bounds of the part \[p − half, p + half\] of the stretch around its point at p, whose
    /// curvature is given.
    ///
    /// Method: Taylor's theorem about the point, with the bounds of the whole stretch.
    pub fn around(&self, point: &Station, curvature: f64, half: f64, side: Side, rounding: f64) -> Bounds {
        let (run, rise) = (half * self.run, half * self.rise);
        let curvature = Interval::of(curvature).grown(half * self.change).cut(self.curvature);
        let turn = curvature.magnitude() * run;
        let off = 0.5 * half * half * self.bend + rounding;
        let chord = [point.cos, point.sin];
        let here = level(chord, [point.x, point.z]);
        let x = Interval::of(point.x).grown(run);
        let z = Interval::of(point.z).grown(rise).grown(rounding);
        let sine = Interval::of(point.sin).grown(turn).cut(self.sine);
        let level = if side == Side::Wheel { here - off } else { here + off };
        Bounds::new([x, z], [sine, curvature], (chord, level), side)
    }
}

/// Turn \[rad\] above which a stretch is cut when a body is prepared: over a quarter of a radian a chord is a
/// poor bound.
const WIDEST_TURN: f64 = 0.25;

/// Variation of the curvature, as a share of its size, above which a stretch is cut, so that most pairs of
/// stretches are decided at once. Stretches below [`LEAST_TURN`] are not cut.
const VARIATION: f64 = 0.5;

/// Turn \[rad\] below which a stretch is not cut: noise of micrometres would be cut into thousands.
const LEAST_TURN: f64 = 0.05;

/// Returns the range of the sines of the directions of some vectors; \[−1, 1\] if one does not point to
/// larger x.
fn cone(x: &[f64], z: &[f64]) -> Interval {
    let (all, mut sines) = (Interval::new(-1.0, 1.0), Interval::new(1.0, -1.0));
    for k in 0..x.len().max(z.len()) {
        let get = |c: &[f64]| c.get(k).or(c.last()).copied().unwrap_or(0.0);
        let (run, rise) = (get(x), get(z));
        let length = run.hypot(rise);
        if length == 0.0 {
            continue;
        }
        if run < 0.0 {
            return all;
        }
        sines = sines.with(rise / length);
    }
    if sines.is_empty() { all } else { sines }
}

/// Returns the derivative's coefficients; a single zero for a constant.
fn derived(c: &[f64]) -> Vec<f64> {
    let out = derivative(c);
    if out.is_empty() { vec![0.0] } else { out }
}

/// Returns a + k b, coefficient by coefficient.
fn sum(a: &[f64], b: &[f64], k: f64) -> Vec<f64> {
    let get = |c: &[f64], i: usize| c.get(i).copied().unwrap_or(0.0);
    (0..a.len().max(b.len())).map(|i| get(a, i) + k * get(b, i)).collect()
}
