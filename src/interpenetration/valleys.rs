//! Where a skewed wheel is parallel to η: the lowest and highest points of all lines of constant ξ, in closed form.
//!
//! A point of the wheel with the profile abscissa p, tangent angle φ = ψ + θ, axle distance ρ of its circle, at the angle v
//! from the wheel's midplane, lies at ξ′ = p + ρ (1 − cos v) sinθ, η′ = ρ sin v. The normal there has no component along η
//! where, with t = tan(v/2),
//!
//! ```text
//! sinχ sin(ψ + 2θ) t² + 2 cosχ cosφ t + sinχ sinψ = 0.
//! ```
//!
//! Of its two roots one is on the side of the rail: every profile point has one such place, and where its ξ grows with p
//! it is the lowest of its line of constant ξ (a valley), where it falls the highest (a ridge). At kinks and ends the
//! profile point is held and φ turns on: the valley follows its circle, the rim. A rim that lines of constant ξ leave and
//! enter again has a second valley, where they do.

use super::profile_path::{Leg, Path, circle_legs};
use crate::numerics::roots::bracketed;
use crate::placement::Placement;
use crate::profile::Section;

/// Farthest a place is looked for from the midplane, as tan(v/2): |η′| = 0.65 ρ. A tilted wheel is taken to end at 0.7 ρ.
pub(super) const FARTHEST: f64 = 0.369;

/// Steps of the surface up to this \[mm\] are rounded coordinates of a drawing and no edges: lines of constant ξ are followed
/// over them. APTA-120 has 4e-3; overhangs leave larger ones.
const DRAWN_STEP: f64 = 1e-2;

/// A root that misses ξ by less than this share is taken.
const ROOT_SHARE: f64 = 4.0 * f64::EPSILON;

/// The wheel's circles in the tangent plane of a skewed placement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turned<'a> {
    pub(super) section: &'a Section,
    /// R, the axle distance of C \[mm\].
    axle: f64,
    /// Of θ.
    sin: f64,
    cos: f64,
    /// Of χ.
    pub(super) sin_skew: f64,
    cos_skew: f64,
}

/// The circle of one profile point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Circle {
    /// Profile abscissa and height in the wheel's contact frame \[mm\].
    p: f64,
    pub(super) height: f64,
    /// Axle distance \[mm\].
    radius: f64,
}

/// A place over the tangent plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) xi: f64,
    pub(super) eta: f64,
}

impl<'a> Turned<'a> {
    fn new(placement: &'a Placement) -> Self {
        let section = &placement.wheel.section;
        let (sin_skew, cos_skew) = placement.skew.sin_cos();
        let axle = placement.rolling_radius();
        Self { section, axle, sin: section.frame.sin, cos: section.frame.cos, sin_skew, cos_skew }
    }

    /// The circle of the profile point at `p` of a piece.
    pub(super) fn circle(&self, piece: usize, p: f64) -> Circle {
        self.circle_with(p, self.section.branches[self.section.pieces[piece].branch].height(p))
    }

    fn circle_with(&self, p: f64, height: f64) -> Circle {
        Circle { p, height, radius: self.axle - p * self.sin - height * self.cos }
    }

    /// The circle of a profile point, and t of its place that is parallel to η, or of the farthest one on that side.
    pub(super) fn parallel(&self, piece: usize, p: f64) -> (Circle, f64) {
        let tangent = self.section.branches[self.section.pieces[piece].branch].station(p);
        let sin_phi = tangent.sin * self.cos + tangent.cos * self.sin;
        let cos_phi = tangent.cos * self.cos - tangent.sin * self.sin;
        let half = cos_phi * self.cos_skew;
        let constant = self.sin_skew * tangent.sin;
        let square = self.sin_skew * (sin_phi * self.cos + cos_phi * self.sin);
        let root = (half * half - constant * square).sqrt();
        let t = -constant / (half + root.copysign(half));
        let far = FARTHEST.copysign(-constant * half);
        let circle = self.circle_with(p, tangent.z);
        (circle, if t.abs() <= FARTHEST { t } else { far })
    }

    /// The place at t on a circle.
    pub(super) fn place(&self, circle: &Circle, t: f64) -> Place {
        let share = 2.0 / (1.0 + t * t);
        let along = circle.p + circle.radius * share * t * t * self.sin;
        let across = circle.radius * share * t;
        Place {
            xi: along * self.cos_skew - across * self.sin_skew,
            eta: along * self.sin_skew + across * self.cos_skew,
        }
    }

    /// ζ of the wheel at t on a circle.
    fn height(&self, circle: &Circle, t: f64) -> f64 {
        circle.height + circle.radius * 2.0 * t * t / (1.0 + t * t) * self.cos
    }

    /// dζ/dξ along any circle.
    fn slope(&self, t: f64) -> f64 {
        let (sin, cos) = (2.0 * t, 1.0 - t * t);
        sin * self.cos / (self.sin * self.cos_skew * sin - self.sin_skew * cos)
    }

    /// dη/dξ along any circle.
    fn rim_slope(&self, t: f64) -> f64 {
        let (along, across) = (2.0 * t * self.sin, 1.0 - t * t);
        (along * self.sin_skew + across * self.cos_skew) / (along * self.cos_skew - across * self.sin_skew)
    }

    /// Rounding of ξ \[mm\].
    pub(super) fn rounding(&self) -> f64 {
        64.0 * f64::EPSILON * self.axle
    }

    /// t where a circle runs along η: there lines of constant ξ touch it.
    pub(super) fn touching(&self) -> f64 {
        ((self.sin_skew / (self.sin * self.cos_skew)).atan() / 2.0).tan()
    }

    /// Whether lines of constant ξ leave and enter the wheel again over the left end (0) or right end (1) of a profile.
    pub(super) fn is_hollow(&self, end: usize) -> bool {
        if end == 0 { self.sin < 0.0 } else { self.sin > 0.0 }
    }

    /// Both t at which the line of constant ξ meets a circle; NaN where it does not.
    fn crossings(&self, circle: &Circle, xi: f64) -> [f64; 2] {
        let constant = circle.p * self.cos_skew - xi;
        let square = constant + 2.0 * circle.radius * self.sin * self.cos_skew;
        let half = circle.radius * self.sin_skew;
        let sum = half + (half * half - square * constant).sqrt().copysign(half);
        [constant / sum, sum / square]
    }
}

/// Where a line has its place at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spot {
    /// η \[mm\].
    pub(super) eta: f64,
    /// \[ζ, dζ/dξ along the line\] on a circle; elsewhere the surface itself is parallel to η.
    pub(super) rim: Option<[f64; 2]>,
}

/// A valley or ridge over an interval of ξ.
#[derive(Debug, Clone)]
pub(super) struct Crease {
    /// Its interval of ξ \[mm\].
    pub(super) xi: [f64; 2],
    pub(super) is_valley: bool,
    /// ξ where a step of a drawing is passed.
    pub(super) steps: Vec<f64>,
    /// In order of ξ.
    legs: Vec<Leg>,
}

/// All valleys and ridges of a wheel.
#[derive(Debug)]
pub(super) struct Valleys<'a> {
    turned: Turned<'a>,
    pub(super) creases: Vec<Crease>,
    /// Circles at which the wheel's surface ends or steps.
    rims: Vec<Circle>,
}

impl<'a> Valleys<'a> {
    /// Those of a placed pair.
    pub(super) fn new(placement: &'a Placement) -> Self {
        let turned = Turned::new(placement);
        let (mut creases, mut rims) = (Vec::new(), Vec::new());
        let runs = runs(placement);
        for (k, run) in runs.iter().enumerate() {
            let path = Path::new(&turned, run);
            let chains = path.monotone(turned.rounding()).into_iter();
            creases.extend(chains.map(|(legs, is_valley)| Crease::new(legs, is_valley)));
            rims.extend(path.ends);
            // A line of constant ξ goes on over a step, if its upper side too is below δ.
            let steps = [k > 0, k + 1 < runs.len()].into_iter().zip(path.ends).filter(|(step, _)| *step);
            let brinks = steps.flat_map(|(_, circle)| circle_legs(&turned, circle));
            creases.extend(brinks.map(|leg| Crease::new(vec![leg], false)));
        }
        Self { turned, creases, rims }
    }

    /// The place of a line at ξ inside its interval.
    pub(super) fn spot(&self, crease: usize, xi: f64) -> Spot {
        let legs = &self.creases[crease].legs;
        let leg = &legs[legs.partition_point(|leg| leg.xi[1] < xi).min(legs.len() - 1)];
        match *leg {
            Leg { piece: Some(piece), range, .. } => {
                let p = self.abscissa(piece, range, xi);
                let (circle, t) = self.turned.parallel(piece, p);
                Spot { eta: self.turned.place(&circle, t).eta, rim: None }
            }
            Leg { circle, range, .. } => {
                let [low, high] = [range[0].min(range[1]), range[0].max(range[1])];
                let outside = |t: &f64| (low - t).max(t - high);
                let [one, other] = self.turned.crossings(&circle, xi);
                // By rounding the line may miss the circle it touches.
                let t = if outside(&one) <= outside(&other) { one } else { other };
                let t = if t.is_nan() { self.turned.touching() } else { t }.clamp(low, high);
                let eta = self.turned.place(&circle, t).eta;
                Spot { eta, rim: Some([self.turned.height(&circle, t), self.turned.slope(t)]) }
            }
        }
    }

    /// The profile abscissa of a piece whose place is at ξ, or the end of its range nearest to that.
    fn abscissa(&self, piece: usize, [from, to]: [f64; 2], xi: f64) -> f64 {
        let miss = |p: f64| {
            let (circle, t) = self.turned.parallel(piece, p);
            let miss = self.turned.place(&circle, t).xi - xi;
            if miss.abs() <= ROOT_SHARE * xi.abs() { 0.0 } else { miss }
        };
        // C itself: towards 0 the bracket is halved a thousand times.
        if xi == 0.0 && from.min(to) <= 0.0 && from.max(to) >= 0.0 && miss(0.0) == 0.0 {
            return 0.0;
        }
        let nearest = || if miss(from).abs() <= miss(to).abs() { from } else { to };
        bracketed(miss, from, to).unwrap_or_else(nearest)
    }

    /// Lines over ξ, by their index.
    pub(super) fn over(&self, xi: f64) -> impl Iterator<Item = usize> {
        (0..self.creases.len()).filter(move |&k| self.creases[k].xi[0] <= xi && xi <= self.creases[k].xi[1])
    }

    /// η at which the line of constant ξ meets ends and steps of the wheel's surface.
    pub(super) fn rims(&self, xi: f64) -> impl Iterator<Item = f64> {
        self.crossings(xi).map(|(place, _)| place.eta)
    }

    /// dη/dξ of the end or step of the wheel's surface that is next to a point; NaN if there is none.
    pub(super) fn rim_slope(&self, xi: f64, eta: f64) -> f64 {
        let off = |place: &Place| (place.eta - eta).abs();
        let nearest = self.crossings(xi).min_by(|(p, _), (q, _)| off(p).total_cmp(&off(q)));
        nearest.map_or(f64::NAN, |(_, t)| self.turned.rim_slope(t))
    }

    /// Where the line of constant ξ meets ends and steps, with t.
    fn crossings(&self, xi: f64) -> impl Iterator<Item = (Place, f64)> {
        self.rims.iter().flat_map(move |rim| {
            let near = self.turned.crossings(rim, xi).into_iter().filter(|t| t.abs() <= FARTHEST);
            near.map(|t| (self.turned.place(rim, t), t))
        })
    }
}

impl Crease {
    fn new(legs: Vec<Leg>, is_valley: bool) -> Self {
        let xi = [legs[0].xi[0], legs[legs.len() - 1].xi[1]];
        let step = |pair: &[Leg]| {
            (pair[0].heights[1] != pair[1].heights[0]).then_some([pair[0].xi[1], pair[1].xi[0]])
        };
        let steps = legs.windows(2).filter_map(step).flatten().collect();
        Self { xi, is_valley, steps, legs }
    }
}

/// Ranges of the envelope's pieces over which the surface neither ends nor steps.
fn runs(placement: &Placement) -> Vec<std::ops::Range<usize>> {
    let pieces = &placement.wheel.section.pieces;
    let mut runs = Vec::new();
    let mut begin = 0;
    for k in 1..=pieces.len() {
        let joined = k < pieces.len()
            && pieces[k - 1].xi[1] == pieces[k].xi[0]
            && (pieces[k - 1].ends[1].1 - pieces[k].ends[0].1).abs() <= DRAWN_STEP;
        if !joined {
            runs.push(begin..k);
            begin = k;
        }
    }
    runs
}
