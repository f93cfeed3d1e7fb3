//! The circles about an axle at which a surface of revolution ends or steps, as lines of constant ξ meet them.

use crate::numerics::interval::Interval;
use crate::placement::Placement;

/// Farthest place from the midplane that is examined, as tan(v/2): |η′| = 0.65 ρ. A tilted wheel is treated as if it ended at 0.7 ρ.
const FARTHEST: f64 = 0.369;
/// sin v there.
pub(super) const FARTHEST_SINE: f64 = 2.0 * FARTHEST / (1.0 + FARTHEST * FARTHEST);

/// The circle of one profile point about the axle.
#[derive(Debug, Clone, Copy)]
struct Circle {
    /// Profile abscissa in the contact frame \[mm\].
    p: f64,
    /// ζ there \[mm\].
    height: f64,
    /// Axle distance \[mm\].
    radius: f64,
}

/// The ends and steps of a wheel, or of a roller upside down.
#[derive(Debug)]
pub(in crate::patch) struct Rims {
    /// Two for every part of the profile without a step, by ascending abscissa.
    circles: Vec<Circle>,
    /// sin θ.
    tilt: f64,
    /// cos θ.
    level: f64,
    /// sin χ and cos χ.
    skew: [f64; 2],
}

impl Rims {
    /// Makes those of the wheel of a placed pair.
    pub(in crate::patch) fn new(placement: &Placement) -> Self {
        let (wheel, axle, skew) = (placement.wheel(), placement.rolling_radius(), placement.skew_rotation());
        let (section, frame) = (&wheel.section, wheel.section.frame);
        let last = section.pieces.len().saturating_sub(1);
        let firsts = std::iter::once(0).chain(section.steps.iter().copied());
        let lasts = section.steps.iter().map(|step| step - 1).chain([last]);
        let circle = |piece: usize, end: usize| {
            let piece = section.pieces.get(piece)?;
            let (p, height) = (piece.xi[end], piece.heights[end]);
            Some(Circle { p, height, radius: axle - p * frame.sin - height * frame.cos })
        };
        let circles = firsts.zip(lasts).flat_map(|(first, last)| [circle(first, 0), circle(last, 1)]);
        Self {
            circles: circles.flatten().collect(),
            tilt: frame.sin,
            level: frame.cos,
            skew: [skew.im, skew.re],
        }
    }

    /// Returns the number of places at which a line may meet a circle.
    pub(super) fn count(&self) -> usize {
        2 * self.circles.len()
    }

    /// Returns η \[mm\] at which the line of ξ meets a circle, by the number of the place; NaN if it does not, or too far from the midplane.
    pub(super) fn met(&self, place: usize, xi: f64) -> f64 {
        let (circle, [sin, cos], t) = (&self.circles[place / 2], self.skew, self.turn(place, xi));
        let share = 2.0 * circle.radius / (1.0 + t * t);
        (circle.p + share * t * t * self.tilt) * sin + share * t * cos
    }

    /// Returns t = tan(v/2) of a place; NaN as for [`Self::met`].
    ///
    /// Method: it is a root of (p cosχ − ξ) (1 + t²) + 2 ρ (t² sinθ cosχ − t sinχ).
    fn turn(&self, place: usize, xi: f64) -> f64 {
        let (circle, [sin, cos]) = (&self.circles[place / 2], self.skew);
        let constant = circle.p * cos - xi;
        let square = constant + 2.0 * circle.radius * self.tilt * cos;
        let half = circle.radius * sin;
        let sum = half + (half * half - square * constant).sqrt().copysign(half);
        let t = if place.is_multiple_of(2) { constant / sum } else { sum / square };
        if t.abs() <= FARTHEST { t } else { f64::NAN }
    }

    /// Returns bounds of dζ/dξ along the circle of a place between two lines that meet it there.
    ///
    /// Method: it changes monotonely with t.
    pub(super) fn slopes(&self, place: usize, xi: Interval) -> Interval {
        let [sin, cos] = self.skew;
        let slope = |t: f64| 2.0 * t * self.level / (2.0 * t * self.tilt * cos - (1.0 - t * t) * sin);
        let [from, to] = xi.ends().map(|xi| slope(self.turn(place, xi)));
        Interval::between(from, to)
    }

    /// Returns ξ, η and ζ \[mm\] at which a line of constant ξ touches the circle of the left (0) or the right (1) end of the profile, or comes
    /// nearest to that.
    pub(in crate::patch) fn touched(&self, end: usize) -> Option<[f64; 3]> {
        let circle = if end == 0 { self.circles.first() } else { self.circles.last() }?;
        Some(self.touched_at(circle))
    }

    /// Returns ξ and η \[mm\] at which two places are one, if these are those of one circle.
    pub(super) fn joined(&self, [one, other]: [usize; 2]) -> Option<[f64; 2]> {
        let [xi, eta, _] = self.touched_at(self.circles.get(one / 2)?);
        (one / 2 == other / 2).then_some([xi, eta])
    }

    fn touched_at(&self, circle: &Circle) -> [f64; 3] {
        let [sin, cos] = self.skew;
        let t = ((sin / (self.tilt * cos)).atan() / 2.0).tan().clamp(-FARTHEST, FARTHEST);
        let share = 2.0 * circle.radius * t / (1.0 + t * t);
        let [along, across] = [circle.p + share * t * self.tilt, share];
        [along * cos - across * sin, along * sin + across * cos, circle.height + share * t * self.level]
    }

    /// Returns whether lines of constant ξ leave the surface over the left (0) or the right (1) end of the profile, and enter it again.
    pub(in crate::patch) fn is_hollow(&self, end: usize) -> bool {
        if end == 0 { self.tilt < 0.0 } else { self.tilt > 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Result;
    use crate::placement::Pair;
    use crate::profile::{Arc, Half, Profile, Segment};
    use crate::separation::Evaluator;

    /// Distance beside a rim \[mm\] at which a surface is looked for.
    const BESIDE: f64 = 1e-6;

    #[test]
    fn a_surface_ends_at_its_rims_and_rises_along_them_as_their_slopes_say() -> Result<()> {
        let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-290.0, 290.0])?;
        let cone = |slope: f64| Arc::line([-20.0, -20.0 * slope], [1.5, 1.5 * slope]);
        let mut met = 0;
        for slope in [-0.8, -0.05, 0.0, 0.3, 1.2] {
            let [rail, wheel] = [rail, cone(slope)?].map(|arc| vec![Segment::arc(arc)]);
            let pair = Pair::new(Profile::new("crown", "", rail)?, Profile::new("cone", "", wheel)?, 460.0)?;
            for skew in [-0.1, -1e-4, 0.02, 0.2] {
                let placement = pair.placed(-300.0 * f64::sin(slope.atan()), 0.0, skew)?;
                let (rims, mut evaluator) = (Rims::new(&placement), Evaluator::new(&placement));
                for (place, k) in (0..rims.count()).flat_map(|place| (0..50).map(move |k| (place, k))) {
                    let xi = Interval::new(-25.0, 25.0).step(k, 50);
                    let [eta, next] = [xi, xi + BESIDE].map(|xi| rims.met(place, xi));
                    let on = |eta: f64| [eta - BESIDE, eta + BESIDE];
                    let mut height =
                        |xi: f64, eta: f64| evaluator.separation(xi, eta) + evaluator.rail_height(xi);
                    let sides = on(eta).map(|eta| height(xi, eta));
                    // Nearly along η a line meets both rims of a circle at once.
                    let Some(side) = (0..2).find(|&side| !sides[side].is_nan() && sides[1 - side].is_nan())
                    else {
                        assert!(
                            eta.is_nan() || (next - eta).abs() > 50.0 * BESIDE,
                            "{slope} {skew} {place} {xi}: {sides:?}"
                        );
                        continue;
                    };
                    let rise = (height(xi + BESIDE, on(next)[side]) - sides[side]) / BESIDE;
                    if !rise.is_nan() {
                        met += 1;
                        let slopes = rims.slopes(place, Interval::new(xi, xi + BESIDE)).grown(1e-6);
                        assert!(slopes.contains(rise), "{slope} {skew} {place} {xi}: {rise}, {slopes:?}");
                    }
                }
            }
        }
        assert!(met > 200, "{met}");
        Ok(())
    }
}
