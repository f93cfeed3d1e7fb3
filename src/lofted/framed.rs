//! A body that varies, seen from a contact frame: the height ζ of a rail that varies along the track, or of a wheel around its axle.
//!
//! A line along ζ meets the surface at a foot, which Newton's method finds on one strip from a place near it. Such places come from
//! sections at equal steps along the surface: runs of points over which it faces the other body.

use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use nalgebra::{Unit, Vector3};

use super::around::LoftedWheel;
use super::build::Loft;
use super::runs::{AscendingRun, LEVEL, runs};
use super::space::{Laid, SpacePoint};
use super::strip::LoftStrip;
use crate::error::Result;
use crate::numerics::interval::Interval;
use crate::profile::{self, Profile, Section, Segment, Side};

/// How far along the track from C a rail is looked at \[mm\]: farther than a wheel reaches.
const FARTHEST: f64 = 4000.0;

/// How far around the axle from C a wheel is looked at \[rad\].
const FARTHEST_AROUND: f64 = 1.3;

/// Least slope of the surface at C, in the frame, at which it touches with an edge: rounding of the place is less, kinks of drawings more.
const EDGE: f64 = 1e-6;

/// Most steps to a foot; three or four are usual.
const STEPS: usize = 40;

/// Most successive steps without a distance from the line below [`SHRINKS`] times the least so far; after more there is no foot.
const PATIENCE: usize = 4;
const SHRINKS: f64 = 0.8;

/// Longest step: in cells across, and in mm along the track.
const LONGEST: [f64; 2] = [4.0, 20.0];

/// Distance from the line along ζ \[mm\] at which the tangent plane is that of the foot: its slopes are off by that distance over the
/// smallest radius, some 1e-11, and the height by far less than rounding.
const NEAR: f64 = 1e-10;

/// Largest distance \[mm\] of two lines along ζ of which one foot leads to the other.
const CLOSE: f64 = 3.0;

/// How far beyond the end of a strip a foot may lie, in cells and in mm: rounding.
const ROUNDING: f64 = 1e-9;

/// Distance \[mm\] along ζ by which another head stands in front, with a flangeway between.
const FLANGEWAY: f64 = 10.0;

/// A body that varies, in a contact frame: the origin is C, ξ lies across the track along the surface, η ahead along the surface, ζ along
/// the normal from rail to wheel.
#[derive(Debug, Clone)]
pub struct FramedLoft {
    loft: Arc<Loft>,
    /// How the surface lies in the body's own axes.
    laid: Laid,
    /// C in the body's own axes \[mm\].
    origin: [f64; 3],
    /// ξ, η and ζ in the body's own axes.
    axes: [[f64; 3]; 3],
    /// Coordinate of C along the surface \[mm\].
    along: f64,
    /// Sections at equal steps, each made when it is needed.
    levels: Vec<OnceLock<Vec<AscendingRun>>>,
    /// Number of the first section, in steps from C.
    first: i64,
    /// Whether it is seen along a normal of the other body, with feet at ξ = 0 only.
    along_normal: bool,
    /// The tangent plane at C.
    plane: Section,
}

/// The point of the surface on a line along ζ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoftFoot {
    /// Index of the strip.
    pub strip: usize,
    /// Parameters u and y \[mm\].
    pub place: [f64; 2],
    /// ζ \[mm\].
    pub zeta: f64,
    /// ∂ζ/∂ξ and ∂ζ/∂η.
    pub slopes: [f64; 2],
    /// ∂(u, y)/∂ξ and ∂(u, y)/∂η.
    steps: [[f64; 2]; 2],
}

/// Feet of lines close to each other, each found from the one before, on a body that is borrowed or kept.
#[derive(Debug)]
pub struct Feet<B> {
    body: B,
    /// The last foot, and its (ξ, η) \[mm\].
    last: Option<(LoftFoot, [f64; 2])>,
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl FramedLoft {
    /// Accuracy of the height of a foot \[mm\] on bodies of usual size.
    pub const ROUNDING: f64 = 5e-13;

    /// Looks at a rail from C \[mm\], with y as its list counts, where its normal leans by θ \[rad\] to the left and by ν \[rad\] ahead:
    /// it is (−sinθ cosν, sinν, cosθ cosν).
    ///
    /// # Errors
    /// None; those of making a profile of the tangent plane.
    pub fn of_rail(loft: Arc<Loft>, origin: [f64; 3], theta: f64, ahead: f64) -> Result<Self> {
        let ((sin, cos), (rise, run)) = (theta.sin_cos(), ahead.sin_cos());
        let axes = [[cos, 0.0, sin], [rise * sin, run, -rise * cos], [-sin * run, rise, cos * run]];
        Self::new(loft, Laid::Along(0.0), (origin, axes), origin[1])
    }

    /// Looks at a wheel from C, which lies at x and z \[mm\] of its profile's axes and at an angle around it \[rad\], as its slices count.
    /// There the profile's tangent leans by θ_W \[rad\], the common normal by λ \[rad\] forward out of the meridian plane, and that
    /// tangent lies at χ \[rad\] from ξ.
    ///
    /// # Errors
    /// None; those of making a profile of the tangent plane.
    pub fn of_wheel(
        wheel: &LoftedWheel,
        ([x, z], around): ([f64; 2], f64),
        [theta, lean, skew]: [f64; 3],
    ) -> Result<Self> {
        let ((sin, cos), (forward, up)) = (theta.sin_cos(), lean.sin_cos());
        let (meridian, ahead) = ([cos, 0.0, sin], [sin * forward, up, -cos * forward]);
        let turned = |a: f64, b: f64| [0, 1, 2].map(|k| a * meridian[k] + b * ahead[k]);
        let axes =
            [turned(skew.cos(), -skew.sin()), turned(skew.sin(), skew.cos()), [-sin * up, forward, cos * up]];
        let upside_down = |[x, y, z]: [f64; 3]| [x, y, -z];
        let along = wheel.radius * around;
        let laid = Laid::Around { radius: wheel.radius, lowest: along };
        Self::new(Arc::clone(&wheel.loft), laid, ([x, 0.0, -z], axes.map(upside_down)), along)
    }

    fn new(
        loft: Arc<Loft>,
        laid: Laid,
        (origin, axes): ([f64; 3], [[f64; 3]; 3]),
        along: f64,
    ) -> Result<Self> {
        let line = profile::Arc::line([-FARTHEST, 0.0], [FARTHEST, 0.0])?;
        let plane = Profile::new("tangent plane", "", vec![Segment::arc(line)])?;
        let plane = Section::own_axes(&plane, Side::Rail);
        Ok(Self::looking((loft, laid), (origin, axes), along, plane))
    }

    fn looking(
        (loft, laid): (Arc<Loft>, Laid),
        (origin, axes): ([f64; 3], [[f64; 3]; 3]),
        along: f64,
        plane: Section,
    ) -> Self {
        let farthest = match laid {
            Laid::Along(_) => FARTHEST,
            Laid::Around { radius, .. } => FARTHEST_AROUND * radius,
        };
        let steps = loft.reach().map(|y| (y - along).clamp(-farthest, farthest) / LEVEL);
        let (first, last) = (steps.low.floor() as i64, steps.high.ceil() as i64);
        let levels = (first..=last).map(|_| OnceLock::new()).collect();
        Self { loft, laid, origin, axes, along, levels, first, along_normal: false, plane }
    }

    /// Gives the body in a frame whose origin is the point (ξ, 0, ζ) \[mm\] of this one and whose ζ is (−sin α, 0, cos α); η keeps its
    /// direction.
    ///
    /// Only feet at ξ = 0 of the new frame may be asked for. Sheets more than 10 mm from the origin, on the side of the other body's
    /// material, are left out: they lie on the far side of that body.
    pub fn turned(&self, [xi, zeta]: [f64; 2], [sin, cos]: [f64; 2]) -> Self {
        let [across, ahead, up] = self.axes;
        let mixed = |a: f64, b: f64| [0, 1, 2].map(|k| a * across[k] + b * up[k]);
        let moved = mixed(xi, zeta);
        let origin = [0, 1, 2].map(|k| self.origin[k] + moved[k]);
        let along = match self.laid {
            Laid::Along(_) => self.along + moved[1],
            Laid::Around { radius, .. } => self.along + radius * (moved[1] / (radius + origin[2])).asin(),
        };
        let axes = [mixed(cos, sin), ahead, mixed(-sin, cos)];
        let body = (Arc::clone(&self.loft), self.laid);
        Self { along_normal: true, ..Self::looking(body, (origin, axes), along, self.plane.clone()) }
    }

    /// Tells which body it is.
    pub fn side(&self) -> Side {
        match self.laid {
            Laid::Along(_) => Side::Rail,
            Laid::Around { .. } => Side::Wheel,
        }
    }

    /// Tells how the surface lies in the body's own axes.
    pub fn laid(&self) -> Laid {
        self.laid
    }

    /// Gives the surface.
    pub fn loft(&self) -> &Arc<Loft> {
        &self.loft
    }

    /// Gives C in the body's own axes \[mm\]; y of a rail as its list counts.
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Gives the directions of ξ, η and ζ in the body's own axes.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        self.axes
    }

    /// Gives the tangent plane at C, in the frame.
    pub(crate) fn plane(&self) -> &Section {
        &self.plane
    }

    /// Gives the coordinate of C along the surface \[mm\]: as the list of a rail counts, or R times the angle around a wheel.
    pub fn along(&self) -> f64 {
        self.along
    }

    /// Estimates the coordinate along the surface \[mm\] at which the line along ζ at (ξ, η) \[mm\] meets it.
    pub fn along_at(&self, xi: f64, eta: f64) -> f64 {
        let ahead = self.axes[0][1] * xi + self.axes[1][1] * eta;
        match self.laid {
            Laid::Along(_) => self.along + ahead.clamp(-FARTHEST, FARTHEST),
            Laid::Around { radius, .. } => {
                let farthest = FARTHEST_AROUND.sin();
                self.along + radius * (ahead / (radius + self.origin[2])).clamp(-farthest, farthest).asin()
            }
        }
    }

    /// Takes a point \[mm\] of the body's own axes into the frame.
    pub fn seen(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let from = [x - self.origin[0], y - self.origin[1], z - self.origin[2]];
        self.axes.map(|axis| dot(axis, from))
    }

    /// Takes a point \[x, z\] of a section at y \[mm\] into the frame.
    pub fn seen_from(&self, at: [f64; 2], y: f64) -> [f64; 3] {
        self.seen(self.laid.place(at, y))
    }

    /// Computes the point (ξ, η, ζ) \[mm\] of a strip, and its derivatives with respect to u and y there.
    pub fn seen_at(&self, strip: &LoftStrip, u: f64, y: f64) -> [[f64; 3]; 3] {
        let p = self.laid.point(strip.point(u, y));
        let [across, along] = self.tangents(&p);
        [self.seen(p.at), across, along]
    }

    /// Finds the foot at (ξ, η) \[mm\]; `None` where the body has no surface that faces the other one.
    ///
    /// Where a line meets several sheets, the one nearest to the tangent plane counts, or one up to 10 mm in front of it: what stands
    /// farther in front belongs to another head. Accuracy: ζ within 1e-12 mm and slopes within 1e-10 on bodies of usual size.
    pub fn foot(&self, xi: f64, eta: f64) -> Option<LoftFoot> {
        let (middle, near) = (self.nearest_level(xi, eta), self.along_at(xi, eta));
        let mut feet: Vec<LoftFoot> = Vec::new();
        for level in [middle, middle - 1, middle + 1] {
            if feet.first().is_some_and(|foot| self.is_alone(foot.strip, xi, middle)) {
                break;
            }
            for run in self.level(level).iter().filter(|run| run.holds(xi)) {
                let y = self.along + LEVEL * level as f64;
                let [from, to] = self.loft.strips[run.strip].reach().ends();
                if near < from - LEVEL || near > to + LEVEL {
                    continue;
                }
                let Some(foot) = self.settle(run.strip, [run.place(xi), y.clamp(from, to)], xi, eta) else {
                    continue;
                };
                if feet.iter().all(|other| (other.zeta - foot.zeta).abs() > ROUNDING) {
                    feet.push(foot);
                }
            }
        }
        if self.along_normal {
            // What the normal meets beyond the other body's material is on the far side of that body.
            let outward = if self.side() == Side::Rail { 1.0 } else { -1.0 };
            feet.retain(|foot| outward * foot.zeta <= FLANGEWAY);
        }
        feet.sort_by(|a, b| a.zeta.total_cmp(&b.zeta));
        if self.side() == Side::Wheel {
            feet.reverse();
        }
        let own = (0..feet.len()).min_by(|&a, &b| feet[a].zeta.abs().total_cmp(&feet[b].zeta.abs()))?;
        let front = (own + 1..feet.len())
            .take_while(|&k| (feet[k].zeta - feet[k - 1].zeta).abs() <= FLANGEWAY)
            .last();
        Some(feet[front.unwrap_or(own)])
    }

    /// Gives the number of the section nearest to a line along ζ, in steps from C.
    fn nearest_level(&self, xi: f64, eta: f64) -> i64 {
        ((self.along_at(xi, eta) - self.along) / LEVEL).round() as i64
    }

    /// Computes the point of a strip in space.
    fn point(&self, strip: &LoftStrip, [u, y]: [f64; 2]) -> SpacePoint {
        self.laid.point(strip.point(u, y))
    }

    /// Computes ∂²ζ/∂ξ², ∂²ζ/∂ξ∂η and ∂²ζ/∂η² at C \[1/mm\]; `None` without a surface there, and where it touches with an edge.
    pub fn bends(&self) -> Option<[f64; 3]> {
        let foot = self.foot(0.0, 0.0).filter(|foot| foot.slopes.iter().all(|slope| slope.abs() < EDGE))?;
        let p = self.point(&self.loft.strips[foot.strip], foot.place);
        let up = |v: [f64; 3]| dot(self.axes[2], v);
        let (l, m, n) = (up(p.across2), up(p.mixed), up(p.along2));
        let [per_xi, per_eta] = foot.steps;
        let form =
            |p: [f64; 2], q: [f64; 2]| l * p[0] * q[0] + m * (p[0] * q[1] + p[1] * q[0]) + n * p[1] * q[1];
        Some([form(per_xi, per_xi), form(per_xi, per_eta), form(per_eta, per_eta)])
    }

    /// Gives ∂/∂u and ∂/∂y of a point in the frame.
    fn tangents(&self, p: &SpacePoint) -> [[f64; 3]; 2] {
        [p.across, p.along].map(|v| self.axes.map(|axis| dot(axis, v)))
    }

    /// Follows one strip to the foot at (ξ, η); `None` if it has none there that faces the other body.
    fn settle(&self, strip: usize, mut place: [f64; 2], xi: f64, eta: f64) -> Option<LoftFoot> {
        let own = &self.loft.strips[strip];
        let (mut least, mut waited) = (f64::INFINITY, 0);
        for _ in 0..STEPS {
            let p = self.point(own, place);
            let at = self.seen(p.at);
            let [a, b] = self.tangents(&p);
            let det = a[0] * b[1] - a[1] * b[0];
            let [off, ahead] = [xi - at[0], eta - at[1]];
            let distance = off.hypot(ahead);
            waited = if distance < SHRINKS * least { 0 } else { waited + 1 };
            least = least.min(distance);
            if waited > PATIENCE {
                return None;
            }
            let step = [(off * b[1] - ahead * b[0]) / det, (a[0] * ahead - a[1] * off) / det];
            if off.abs() <= NEAR && ahead.abs() <= NEAR && det > 0.0 {
                place = [place[0] + step[0], place[1] + step[1]];
                let zeta = at[2] + a[2] * step[0] + b[2] * step[1];
                let slopes = [(a[2] * b[1] - a[1] * b[2]) / det, (a[0] * b[2] - a[2] * b[0]) / det];
                let steps = [[b[1] / det, -a[1] / det], [-b[0] / det, a[0] / det]];
                let foot = LoftFoot { strip, place, zeta, slopes, steps };
                return on(own, place).then_some(foot);
            }
            let share = (0..2).map(|k| LONGEST[k] / step[k].abs()).fold(1.0, f64::min);
            if share.is_nan() || share <= 0.0 {
                return None;
            }
            // Steps may go a cell or a millimetre beyond the strip, and come back.
            let limits = [Interval::new(0.0, own.cells() as f64), own.reach()].map(|range| range.grown(1.0));
            let next = [0, 1].map(|k| (place[k] + share * step[k]).clamp(limits[k].low, limits[k].high));
            if next == place {
                return None;
            }
            place = next;
        }
        None
    }

    /// Tells whether all runs near ξ in the sections around a level belong to one strip's sheet. A neighbouring part joins the strip at
    /// its end: it belongs to that sheet unless ξ lies within the part.
    fn is_alone(&self, strip: usize, xi: f64, level: i64) -> bool {
        let part = |strip: usize| self.loft.strips[strip].part;
        (level - 1..=level + 1).all(|level| {
            let mut last = None;
            self.level(level).iter().filter(|run| run.holds(xi)).all(|run| {
                let folds = last.replace(run.strip) == Some(run.strip);
                let apart = part(run.strip).abs_diff(part(strip));
                !folds && (apart == 0 || apart == 1 && !run.covers(xi))
            })
        })
    }

    /// Gives the range of ξ \[mm\] over which the surface faces the other body between two η \[mm\]; `None` if it does so nowhere.
    pub fn reach(&self, eta: Interval) -> Option<Interval> {
        let [from, to] = eta.ends().map(|eta| self.nearest_level(0.0, eta));
        let runs = (from..=to).flat_map(|level| self.level(level));
        let reach = runs.map(AscendingRun::reach).fold(Interval::NONE, Interval::hull);
        (reach.has_width()).then_some(reach)
    }

    fn level(&self, level: i64) -> &[AscendingRun] {
        let Ok(index) = usize::try_from(level - self.first) else { return &[] };
        let (y, xi) = (self.along + LEVEL * level as f64, |at: [f64; 2], y: f64| self.seen_from(at, y)[0]);
        let made = || runs(&self.loft, xi, y, self.along_normal);
        self.levels.get(index).map_or(&[], |runs| runs.get_or_init(made))
    }
}

/// Tells whether a place lies on a strip.
fn on(strip: &LoftStrip, [u, y]: [f64; 2]) -> bool {
    Interval::new(0.0, strip.cells() as f64).grown(ROUNDING).contains(u)
        && strip.reach().grown(ROUNDING).contains(y)
}

impl<B: Deref<Target = FramedLoft>> Feet<B> {
    /// Begins without a foot.
    pub fn new(body: B) -> Self {
        Self { body, last: None }
    }

    /// Gives the body.
    pub fn body(&self) -> &FramedLoft {
        &self.body
    }

    /// Forgets the last foot, so that the next one has the same bits whatever was before.
    pub fn forget(&mut self) {
        self.last = None;
    }

    /// Finds the foot at (ξ, η) \[mm\], as [`FramedLoft::foot`] does.
    pub fn at(&mut self, xi: f64, eta: f64) -> Option<LoftFoot> {
        let near = self.last.as_ref().map(|(foot, at)| (foot, [xi - at[0], eta - at[1]]));
        let near = near.filter(|(_, step)| step.iter().all(|step| step.abs() <= CLOSE));
        let level = self.body.nearest_level(xi, eta);
        let near = near.filter(|(foot, _)| self.body.is_alone(foot.strip, xi, level));
        let beside = near.and_then(|(foot, step)| self.body.settle(foot.strip, foot.moved(step), xi, eta));
        let foot = beside.or_else(|| self.body.foot(xi, eta))?;
        self.last = Some((foot, [xi, eta]));
        Some(foot)
    }

    /// Computes ζ(ξ, η) \[mm\]; NaN where the body has no surface that faces the other one.
    pub fn height(&mut self, xi: f64, eta: f64) -> f64 {
        self.at(xi, eta).map_or(f64::NAN, |foot| foot.zeta)
    }
}

impl LoftFoot {
    /// Gives the upward unit normal (ξ, η, ζ): a rail's outward one, a wheel's inward one.
    pub fn normal(&self) -> Unit<Vector3<f64>> {
        Unit::new_normalize(Vector3::new(-self.slopes[0], -self.slopes[1], 1.0))
    }

    /// Gives the place to which a step in ξ and η \[mm\] leads along the tangent plane.
    fn moved(&self, [xi, eta]: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| self.place[k] + xi * self.steps[0][k] + eta * self.steps[1][k])
    }
}
