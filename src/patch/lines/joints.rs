//! Finds where an edge of the patch passes a joint of the wheel or of a roller.

use nalgebra::UnitComplex;

use super::Lines;
use super::ranges::SHALLOW;
use crate::numerics::interval::Interval;
use crate::numerics::roots::change;
use crate::placement::Placement;
use crate::separation::Relief;
use crate::separation::wheel_surface::{WheelSurface, sagitta};

/// Share of the half-length of a slice, as a parabola has it, by which edges may lie farther off.
const FARTHER: f64 = 0.5;

/// Most steps to where a joint is under an edge.
const STEPS: usize = 24;

/// Factor by which a circle is farther from the patch than a step along a parabola leads down, and is taken not to reach it.
const SURELY: f64 = 4.0;

/// Factor by which that place is sought farther out.
const WIDER: f64 = 1.25;

/// Factor by which it is sought nearer, where nothing faces the joint.
const NEARER: f64 = 0.5;

/// Newton steps to the place of the raised curve at ξ; over the tangent plane the first one leads there.
const TO_PLACE: usize = 3;

/// The circle of a joint about the axle.
struct JointCircle {
    /// Abscissa in the contact frame \[mm\].
    p: f64,
    /// ζ there \[mm\].
    height: f64,
    /// Distance from the axle \[mm\].
    radius: f64,
    /// sin θ and cos θ.
    tilt: [f64; 2],
    skew: UnitComplex<f64>,
}

/// A place on the circle of a joint.
struct CirclePlace {
    /// ξ, η and ζ \[mm\].
    at: [f64; 3],
    /// How fast they change with y.
    moves: [f64; 3],
}

/// What faces the circle of a joint, so that the gap less δ there is ζ of the circle and this height.
enum FacingBody<'a> {
    /// What is raised from a rail, seen upside down.
    Raised,
    /// A roller raised by δ, seen upside down.
    Roller(Relief<'a>),
    /// The wheel lowered by δ.
    Wheel(Relief<'a>),
}

impl JointCircle {
    /// Returns the place at y = η′ on the circle \[mm\].
    fn at(&self, y: f64) -> CirclePlace {
        let ([tilt, level], below) = (self.tilt, (self.radius * self.radius - y * y).sqrt());
        let (e, turn) = (sagitta(below, y * y), y / below);
        let (own, run, sin, cos) = (self.p + e * tilt, turn * tilt, self.skew.im, self.skew.re);
        CirclePlace {
            at: [own * cos - y * sin, y * cos + own * sin, self.height + e * level],
            moves: [run * cos - sin, cos + run * sin, turn * level],
        }
    }

    /// Returns y \[mm\] of the place nearest to the midplane whose ξ lies in a range.
    ///
    /// Method: Newton's steps. Degenerate: 0 where they lead nowhere.
    fn beside(&self, range: Interval) -> f64 {
        let mut y = 0.0;
        for _ in 0..TO_PLACE {
            let CirclePlace { at: [xi, ..], moves: [run, ..] } = self.at(y);
            let off = xi - range.nearest(xi);
            if off == 0.0 {
                break;
            }
            y -= off / run;
        }
        if y.abs() < self.radius { y } else { 0.0 }
    }
}

/// Finds where edges of the patch on lines pass joints.
pub(in crate::patch) struct PassedJoints<'l, 'a> {
    pub(in crate::patch) lines: &'l mut Lines<'a>,
}

impl PassedJoints<'_, '_> {
    /// Appends the ξ or σ inside a range at which an edge passes a joint of the wheel, or of a roller over the tangent plane. `depth`
    /// \[mm\] is that of the patch.
    ///
    /// Method: along the circle of a joint the gap is nearly a parabola, beside whose roots those are sought. A joint that is missed costs
    /// the boundary some more stretches.
    pub(in crate::patch) fn within(mut self, over: Interval, depth: f64, places: &mut Vec<f64>) {
        let placement = self.lines.gap.placement();
        let half = (depth.max(0.0) / self.lines.gap.opening).sqrt();
        let below =
            placement.under().map_or(FacingBody::Raised, |under| FacingBody::Roller(Relief::new(under)));
        self.of_body((placement, below), (over, half), places);
        if let Some(under) = placement.under() {
            self.of_body((under, FacingBody::Wheel(Relief::new(placement))), (over, half), places);
        }
    }

    fn of_body(
        &mut self,
        (body, mut facing): (&Placement, FacingBody<'_>),
        (over, half): (Interval, f64),
        places: &mut Vec<f64>,
    ) {
        let (surface, skew) = (WheelSurface::new(body), body.skew_rotation());
        let lowest = over.ends().map(|xi| self.lines.lowest(xi, 0.0).abs());
        let far = lowest[0].max(lowest[1]) + (1.0 + FARTHER) * half;
        let aside = far * skew.im.abs() + far * far / surface.axle * surface.sin.abs();
        let [feet, _] = self.lines.gap.feet(over);
        let range = feet.grown(aside);
        let mut joints: Vec<(f64, f64)> = surface.section.joints(range).collect();
        joints.dedup_by_key(|(p, _)| *p);
        for (p, height) in joints {
            let radius = surface.axle_distance(p, height);
            let circle = JointCircle { p, height, radius, tilt: [surface.sin, surface.cos], skew };
            if self.lines.gap.is_over_plane() && surface.sin == 0.0 && skew.im == 0.0 {
                places.extend(over.surrounds(p).then_some(p));
                continue;
            }
            let from = circle.beside(feet);
            let sides: &[f64] = if self.lines.gap.is_skewed() { &[-1.0, 1.0] } else { &[1.0] };
            let passed = sides.iter().filter_map(|side| self.passed((&circle, &mut facing), (from, *side)));
            places.extend(passed.filter(|xi| over.surrounds(*xi)));
        }
    }

    /// Returns ξ or σ \[mm\] where the circle of a joint leaves the patch on one side.
    ///
    /// Method: from y = `from` \[mm\] down to the lowest place, or the patch; outwards from there until the gap is positive, and back to where
    /// it passes δ.
    fn passed(
        &mut self,
        (circle, facing): (&JointCircle, &mut FacingBody<'_>),
        (from, side): (f64, f64),
    ) -> Option<f64> {
        let opening = self.lines.gap.opening;
        let (mut sigma, mut lowest) = (self.lines.gap.sigma(circle.at(from).at[0]), from);
        let mut half = f64::NAN;
        for _ in 0..STEPS {
            let [gap, slope] = self.on_circle((circle, facing), lowest, &mut sigma)?;
            half = (-gap / opening).sqrt();
            let step = slope / (2.0 * opening);
            if half > 0.0 || gap > SURELY * opening * step * step {
                break;
            }
            lowest -= step;
        }
        // NaN where the circle does not reach the patch.
        if half.is_nan() {
            return None;
        }
        for _ in 0..STEPS {
            let y = lowest + side * half;
            match self.on_circle((circle, facing), y, &mut sigma) {
                Some([gap, _]) if gap < 0.0 => half *= WIDER,
                Some(_) => {
                    let enough = self.lines.gap.roundings(SHALLOW);
                    let mut depth = |y: f64| Some(self.on_circle((circle, facing), y, &mut sigma)?[0]);
                    let y = change(|y| depth(y).unwrap_or(f64::NAN), [lowest, y], enough);
                    return depth(y).map(|_| sigma);
                }
                // Nothing faces it that far out.
                None => {
                    half *= NEARER;
                    sigma = self.lines.gap.sigma(circle.at(lowest).at[0]);
                }
            }
        }
        None
    }

    /// Moves ξ or σ to the place at y on a circle, and returns the gap less δ there \[mm\] and its slope along y; `None` where nothing faces
    /// it.
    fn on_circle(
        &mut self,
        (circle, facing): (&JointCircle, &mut FacingBody<'_>),
        y: f64,
        sigma: &mut f64,
    ) -> Option<[f64; 2]> {
        let CirclePlace { at: [xi, eta, height], moves } = circle.at(y);
        for _ in 0..TO_PLACE {
            let (here, along) = self.lines.gap.xi_and_run(*sigma);
            *sigma += (xi - here) / along;
        }
        let gap = &self.lines.gap;
        let rail = &gap.placement().rail().section;
        let profile =
            |xi: f64| rail.branch_at(xi).map(|branch| [branch.height(xi), branch.chord_slope(xi, xi)]);
        let [facing, along, across] = match facing {
            FacingBody::Raised => {
                let raised = gap.raised()?;
                let (at, [_, rise]) = (raised.at(*sigma), raised.direction(*sigma));
                [-rail.height(at.foot) - at.moved[1], -rise, 0.0]
            }
            FacingBody::Roller(relief) => {
                let point = relief.point(xi, eta)?;
                let [along, across] = relief.slopes(&point);
                [relief.height_at(xi, &point) - profile(xi)?[0] - gap.approach(), along, across]
            }
            FacingBody::Wheel(relief) => {
                let point = relief.point(xi, eta)?;
                let [along, across] = relief.slopes(&point);
                [relief.height_at(xi, &point) + profile(xi)?[0] - gap.approach(), along, across]
            }
        };
        let (_, run) = gap.xi_and_run(*sigma);
        let slope = moves[2] + along * moves[0] / run + across * moves[1];
        Some([height + facing, slope])
    }
}
