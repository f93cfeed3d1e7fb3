//! The circles about their axles at which the wheel and a roller end or step, as lines of constant ξ meet them.

use crate::numerics::interval::Interval;
use crate::placement::Placement;
use crate::profile::Side;

/// Farthest place from the midplane that is examined, as tan(v/2): |η′| = 0.65 ρ. A tilted wheel is treated as if it ended at 0.7 ρ.
const FARTHEST: f64 = 0.369;
/// sin v there.
pub(super) const FARTHEST_SINE: f64 = 2.0 * FARTHEST / (1.0 + FARTHEST * FARTHEST);

/// The circle of one profile point about the axle.
#[derive(Debug, Clone, Copy)]
struct Circle {
    /// [`Side::Rail`] for a roller.
    body: Side,
    /// Profile abscissa in the contact frame \[mm\].
    p: f64,
    /// Height there \[mm\]: ζ of a wheel, −ζ of a roller.
    height: f64,
    /// Axle distance \[mm\].
    radius: f64,
    /// sin θ and cos θ.
    tilt: [f64; 2],
    /// sin χ and cos χ.
    skew: [f64; 2],
}

/// The ends and steps of a wheel, and of a roller upside down.
#[derive(Debug)]
pub(in crate::patch) struct Rims {
    /// For each body two for every part of the profile without a step, by ascending abscissa.
    circles: Vec<Circle>,
}

impl Rims {
    /// Makes those of the wheel of a placed pair, and of a roller.
    pub(in crate::patch) fn new(placement: &Placement) -> Self {
        let wheel = circles(placement, Side::Wheel);
        let roller = placement.under().into_iter().flat_map(|under| circles(under, Side::Rail));
        Self { circles: wheel.chain(roller).collect() }
    }

    /// Returns the body that a place bounds.
    pub(super) fn body(&self, place: usize) -> Side {
        self.circles[place / 2].body
    }

    /// Returns the number of places at which a line may meet a circle.
    pub(super) fn count(&self) -> usize {
        2 * self.circles.len()
    }

    /// Returns η \[mm\] at which the line of ξ meets a circle, by the number of the place; NaN if it does not, or too far from the midplane.
    pub(super) fn met(&self, place: usize, xi: f64) -> f64 {
        let (circle, t) = (&self.circles[place / 2], self.turn(place, xi));
        let [sin, cos] = circle.skew;
        let share = 2.0 * circle.radius / (1.0 + t * t);
        (circle.p + share * t * t * circle.tilt[0]) * sin + share * t * cos
    }

    /// Returns t = tan(v/2) of a place; NaN as for [`Self::met`].
    ///
    /// Method: it is a root of (p cosχ − ξ) (1 + t²) + 2 ρ (t² sinθ cosχ − t sinχ).
    fn turn(&self, place: usize, xi: f64) -> f64 {
        let circle = &self.circles[place / 2];
        let [sin, cos] = circle.skew;
        let constant = circle.p * cos - xi;
        let square = constant + 2.0 * circle.radius * circle.tilt[0] * cos;
        let half = circle.radius * sin;
        let sum = half + (half * half - square * constant).sqrt().copysign(half);
        let t = if place.is_multiple_of(2) { constant / sum } else { sum / square };
        if t.abs() <= FARTHEST { t } else { f64::NAN }
    }

    /// Returns bounds of the slope of the circle's height along ξ, and of dη/dξ, between two lines that meet it at a place.
    ///
    /// Method: both change monotonely with tan v.
    pub(super) fn slopes(&self, place: usize, xi: Interval) -> [Interval; 2] {
        let Circle { tilt: [tilt, level], skew: [sin, cos], .. } = self.circles[place / 2];
        let ends = xi.ends().map(|xi| {
            let t = self.turn(place, xi);
            let (y, square) = (2.0 * t, 1.0 - t * t);
            let run = y * tilt * cos - square * sin;
            [y * level / run, (y * tilt * sin + square * cos) / run]
        });
        [0, 1].map(|k| Interval::between(ends[0][k], ends[1][k]))
    }

    /// Returns the circles of the ends of each body's profile, with −1 on the left and 1 on the right.
    fn ends(&self) -> impl Iterator<Item = (&Circle, f64)> {
        let bodies = self.circles.chunk_by(|a, b| a.body == b.body);
        let ends = bodies.flat_map(|own| [own.first().zip(Some(-1.0)), own.last().zip(Some(1.0))]);
        ends.flatten()
    }

    /// Returns η \[mm\] at which lines of constant ξ touch the circles of the ends, or come nearest to that.
    pub(super) fn turning(&self) -> Vec<f64> {
        self.ends().map(|(circle, _)| touched(circle)[1]).collect()
    }

    /// Returns the body, and ξ, η and height \[mm\] of the place where a line of constant ξ touches the circle or comes nearest to it, for each
    /// end over which such lines leave the surface and enter it again.
    pub(in crate::patch) fn hollow_ends(&self) -> impl Iterator<Item = (Side, [f64; 3])> {
        let hollow = self.ends().filter(|(circle, outwards)| circle.tilt[0] * outwards > 0.0);
        hollow.map(|(circle, _)| (circle.body, touched(circle)))
    }

    /// Returns ξ and η \[mm\] at which two places are one, if these are those of one circle.
    pub(super) fn joined(&self, [one, other]: [usize; 2]) -> Option<[f64; 2]> {
        let [xi, eta, _] = touched(self.circles.get(one / 2)?);
        (one / 2 == other / 2).then_some([xi, eta])
    }
}

/// Returns the circles of the wheel of a placed pair, as those of `body`: a roller is the wheel of a pair upside down.
fn circles(placement: &Placement, body: Side) -> impl Iterator<Item = Circle> {
    let (section, axle) = (&placement.wheel().section, placement.rolling_radius());
    let (tilt, skew) = ([section.frame.sin, section.frame.cos], placement.skew_rotation());
    let last = section.pieces.len().saturating_sub(1);
    let firsts = std::iter::once(0).chain(section.steps.iter().copied());
    let lasts = section.steps.iter().map(|step| step - 1).chain([last]);
    let circle = move |piece: usize, end: usize| {
        let piece = section.pieces.get(piece)?;
        let (p, height) = (piece.xi[end], piece.heights[end]);
        let radius = axle - p * tilt[0] - height * tilt[1];
        Some(Circle { body, p, height, radius, tilt, skew: [skew.im, skew.re] })
    };
    firsts.zip(lasts).flat_map(move |(first, last)| [circle(first, 0), circle(last, 1)]).flatten()
}

/// Returns ξ, η and height \[mm\] at which a line of constant ξ touches a circle, or comes nearest to that.
fn touched(circle: &Circle) -> [f64; 3] {
    let Circle { tilt: [tilt, level], skew: [sin, cos], .. } = *circle;
    let t = ((sin / (tilt * cos)).atan() / 2.0).tan().clamp(-FARTHEST, FARTHEST);
    let share = 2.0 * circle.radius * t / (1.0 + t * t);
    let [along, across] = [circle.p + share * t * tilt, share];
    [along * cos - across * sin, along * sin + across * cos, circle.height + share * t * level]
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
                        let [slopes, turns] = rims.slopes(place, Interval::new(xi, xi + BESIDE));
                        assert!(
                            slopes.grown(1e-6).contains(rise),
                            "{slope} {skew} {place} {xi}: {rise}, {slopes:?}"
                        );
                        let turn = (next - eta) / BESIDE;
                        assert!(
                            turns.grown(1e-6 * (1.0 + turn.abs())).contains(turn),
                            "{slope} {skew} {place} {xi}: {turn}, {turns:?}"
                        );
                    }
                }
            }
        }
        assert!(met > 200, "{met}");
        Ok(())
    }
}
