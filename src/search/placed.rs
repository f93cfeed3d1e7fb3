//! Places bounds in the rail's axes, and bounds the gap between two of them.
//!
//! A wheel's ring at the profile point (x, z) reaches, along the normal of an outline tangent Θ without roll,
//! as far as the point itself along the normal of φ, sinφ = sinΘ cosψ, except for a constant:
//!
//! ```text
//! Z cosΘ − X sinΘ ≥ (z cosφ − x sinφ) − R (cosφ − cosΘ)
//! ```
//!
//! with equality at the outline. So a line below the profile is a line below its outline, whatever the yaw.
//! Bounds of the profile whose width shrinks with the square of its length do so for the outline too.

use super::bounds::{Bounds, STEEPEST_SLOPE};
use super::locus::Attitude;
use crate::numerics::cosine;
use crate::numerics::interval::Interval;

/// Bounds in the rail's axes: of a part of the rail, or of the outline of a part of the wheel.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlacedBounds {
    /// Least and largest abscissa \[mm\].
    pub x: Interval,
    /// Least and largest sine of the tangents; ∓1 for tangents beyond the vertical.
    pub sine: Interval,
    /// Line z = level + slope x below a wheel or above a rail: height at x = 0 \[mm\] and slope.
    pub line: [f64; 2],
}

impl PlacedBounds {
    /// Bounds of a part without outline: no abscissa and no tangent.
    pub const HIDDEN: Self = Self { x: Interval::NONE, sine: Interval::NONE, line: [f64::INFINITY, 0.0] };

    /// Takes the bounds of a part of the rail.
    pub fn rail(bounds: &Bounds) -> Self {
        Self { x: bounds.x, sine: bounds.sine, line: bounds.line }
    }

    /// Returns the abscissae that this part of the wheel shares with a part of the rail \[mm\]; empty if there
    /// are none.
    #[inline(always)]
    pub fn shared(&self, rail: &Self) -> Interval {
        cut(self.x, rail.x)
    }

    /// Returns a lower bound of the gap of this part of the wheel over a part of the rail \[mm\]; infinite if
    /// they have no abscissa or no tangent in common.
    #[inline(always)]
    pub fn gap_over(&self, rail: &Self) -> f64 {
        let (x, sine) = (self.shared(rail), cut(self.sine, rail.sine));
        let (level, slope) = (self.line[0] - rail.line[0], self.line[1] - rail.line[1]);
        let gap = level + smaller(slope * x.low, slope * x.high);
        if (x.low <= x.high) & (sine.low <= sine.high) { gap } else { f64::INFINITY }
    }

    /// Narrows the abscissae to those within `reach` of `middle` \[mm\]; changes nothing if either is NaN.
    pub fn narrow(&mut self, middle: f64, reach: f64) {
        self.x = self.x.cut(Interval::of(middle).grown(reach));
    }

    /// Returns the bounds, wider by the rounding of an abscissa \[mm\] and of a sine.
    #[inline]
    #[must_use]
    pub fn widened(self, abscissa: f64, sine: f64) -> Self {
        Self { x: self.x.grown(abscissa), sine: self.sine.grown(sine), ..self }
    }
}

/// Returns the larger of two numbers that are not NaN, by one instruction.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// Returns the smaller of two numbers that are not NaN, by one instruction.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Returns what two intervals share, whose ends are not NaN; empty if nothing.
#[inline(always)]
fn cut(a: Interval, b: Interval) -> Interval {
    Interval::new(larger(a.low, b.low), smaller(a.high, b.high))
}

/// Places the bounds of a part of the wheel; [`PlacedBounds::HIDDEN`] if it has no outline that is seen.
#[inline]
pub fn placed_bounds(attitude: &Attitude, bounds: &Bounds) -> PlacedBounds {
    if attitude.sin_yaw == 0.0 && attitude.sin_roll == 0.0 {
        let [level, slope] = bounds.line;
        let x = bounds.x + attitude.offset;
        return PlacedBounds { x, sine: bounds.sine, line: [level - slope * attitude.offset, slope] };
    }
    if attitude.sin_yaw == 0.0 {
        let Bounds { x, z, sine, cosine, chord, level, .. } = *bounds;
        return rolled_bounds(attitude, &OutlineBounds { x, z, sine, cosine: [cosine; 2], chord, level });
    }
    yawed(attitude, bounds).map_or(PlacedBounds::HIDDEN, |outline| rolled_bounds(attitude, &outline))
}

/// Returns the bounds of the outline before the roll; `None` if it is hidden.
#[inline]
fn yawed(attitude: &Attitude, bounds: &Bounds) -> Option<OutlineBounds> {
    let steepest = attitude.steepest_tangent;
    if bounds.tangent.low >= steepest || bounds.tangent.high <= -steepest {
        return None;
    }
    let tangent = cut(bounds.tangent, Interval::symmetric(steepest));
    let most = bounds.curvature.high;
    if most < 0.0 && 1.0 + most * (attitude.radius - bounds.z.high) * attitude.sin_yaw_squared() <= 0.0 {
        // The rings beside it hide it, even where its tangent is level: steeper rings are wider.
        return None;
    }
    let rolling = bounds.z.ends().map(|z| attitude.radius - z);
    // ϱ tanφ tanψ sinψ, with the radius that makes it extreme.
    let shift = Interval::new(
        tangent.low * attitude.shift * rolling[usize::from(tangent.low > 0.0)],
        tangent.high * attitude.shift * rolling[usize::from(tangent.high < 0.0)],
    );
    let x = bounds.x.map(|x| x * attitude.cos_yaw) + shift;
    // 1 − cosω ≤ sin²ω.
    let sin_omega = larger(-tangent.low, tangent.high) * attitude.tan_yaw;
    let z = Interval { high: bounds.z.high + rolling[0] * sin_omega * sin_omega, ..bounds.z };
    let sine = cut(bounds.sine.map(|sin| sin / attitude.cos_yaw), Interval::new(-1.0, 1.0));
    // cosΘ = √(cos²φ − sin²ψ)/cosψ lies between cosφ − |sinψ| and cosφ.
    let away = attitude.sin_yaw.abs();
    let least = [larger(bounds.cosine[0] - away, 0.0), larger(bounds.cosine[1] - away, 0.0)];
    let [cos, sin] = bounds.chord;
    let outline_sin = sin / attitude.cos_yaw;
    let outline_cos = larger((1.0 - outline_sin) * (1.0 + outline_sin), 0.0).sqrt();
    // cosφ − cosΘ, free of cancellation.
    let nearer = outline_sin * outline_sin * attitude.sin_yaw_squared() / (cos + outline_cos);
    Some(OutlineBounds {
        x,
        z,
        sine,
        cosine: [least, bounds.cosine],
        chord: [outline_cos, outline_sin],
        level: bounds.level - attitude.radius * nearer,
    })
}

#[inline]
fn rolled_bounds(attitude: &Attitude, outline: &OutlineBounds) -> PlacedBounds {
    let (cos, sin) = (attitude.cos_roll, attitude.sin_roll);
    let [x, z, sine] = [outline.x, outline.z, outline.sine].map(Interval::ends);
    let [least, most] = outline.cosine;
    let (rising, falling) = if sin > 0.0 { (1, 0) } else { (0, 1) };
    let [chord_cos, chord_sin] = outline.chord;
    let turned = chord_cos * cos + chord_sin * sin;
    let line = if chord_cos > 0.0 && turned * STEEPEST_SLOPE >= 1.0 {
        let slope = (chord_sin * cos - chord_cos * sin) / turned;
        [outline.level / turned - slope * attitude.offset, slope]
    } else {
        [z[0] * cos - x[rising] * sin, 0.0]
    };
    let x = Interval::new(
        attitude.offset + x[0] * cos + z[falling] * sin,
        attitude.offset + x[1] * cos + z[rising] * sin,
    );
    // The largest and the least that the roll subtracts, and ∓1 where it may turn beyond the vertical.
    let off = if sin > 0.0 { [most[0], least[1]] } else { [least[0], most[1]] };
    let beyond = |end: usize| least[end] * cos + sine[end] * sin < 0.0;
    let first = if sine[0] < 0.0 && beyond(0) { -1.0 } else { sine[0] * cos - off[0] * sin };
    let last = if sine[1] > 0.0 && beyond(1) { 1.0 } else { sine[1] * cos - off[1] * sin };
    PlacedBounds { x, sine: Interval::new(first, last), line }
}

/// Returns bounds of the outline's curvature where a part of the profile is seen, and the largest
/// |dX/dx_W| along the whole part; `None` if the rings beside it hide all of it.
pub fn outline_bounds(attitude: &Attitude, bounds: &Bounds) -> Option<(Interval, f64)> {
    let [least, most] = bounds.curvature.ends();
    let sin = larger(-bounds.sine.low, bounds.sine.high) / attitude.cos_yaw;
    let turned = attitude.cos_roll + sin / cosine(sin) * attitude.sin_roll.abs();
    if attitude.sin_yaw == 0.0 {
        return Some((bounds.curvature, turned));
    }
    let level = bounds.sine.contains(0.0);
    let cos = bounds.cosine.map(|cos| cos.max(attitude.sin_yaw.abs()));
    let (steep, flat) = (cos[0].min(cos[1]), if level { 1.0 } else { cos[0].max(cos[1]) });
    let tilt = [flat, steep].map(|cos| (attitude.sin_yaw_squared() / (cos * cos)).min(1.0));
    let rolling = bounds.z.ends().map(|z| attitude.radius - z);
    let ring = [rolling[1] * tilt[0] / flat, rolling[0] * tilt[1] / steep];
    // The outline's radius is r (1 − tilt) + ring; with the hollow side down and a ring larger than r it
    // is hidden.
    let seen = |curvature: f64, k: usize| 1.0 - tilt[k] + curvature * ring[k];
    let highest = if most > 0.0 {
        (most.recip() * (1.0 - tilt[1]) + ring[0]).recip()
    } else {
        let seen = seen(most, 0);
        if seen <= 0.0 {
            return None;
        }
        most / seen
    };
    let lowest = if least > 0.0 {
        (least.recip() * (1.0 - tilt[0]) + ring[1]).recip()
    } else {
        let seen = seen(least, 1);
        if seen > 0.0 { least / seen } else { f64::NEG_INFINITY }
    };
    // dX/dx_W = (cos(roll) + tanΘ sin(roll)) (1 − tilt + κ ring)/cosψ.
    let most_seen = 1.0 - tilt[0] + most * ring[usize::from(most > 0.0)];
    let least_seen = 1.0 - tilt[1] + least * ring[usize::from(least < 0.0)];
    Some((Interval::new(lowest, highest), most_seen.max(-least_seen) * turned / attitude.cos_yaw))
}

/// Bounds of an outline before the roll.
struct OutlineBounds {
    x: Interval,
    z: Interval,
    sine: Interval,
    /// Least and largest cosine of the tangents at both ends of the range of sines.
    cosine: [[f64; 2]; 2],
    /// Direction of the line below the outline, \[cos, sin\]; cos is 0 if there is no line.
    chord: [f64; 2],
    level: f64,
}
