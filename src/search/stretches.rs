//! Solves pairs with a stretch of a polynomial or a yawed arc: cuts them until the bounds of the parts
//! decide, then uses Newton's method.
//!
//! At an abscissa X that both outlines pass, the sines of their tangents differ by D(X), and
//!
//! ```text
//! dD/dX = κ_W − κ_R
//! ```
//!
//! with the curvatures of the outline and of the rail at X, however steep they are. So bounds of the two
//! curvatures tell whether there is no common tangent, one at most, or only largest gaps; from any point of
//! either part the mean value theorem tells where a common tangent must be.

use super::body::LEAST_KINK;
use super::bounds::Bounds;
use super::candidates::{EQUAL_CURVATURES, Foot, Search};
use super::element::{Element, ElementCurve, ElementPoint, rising_root};
use super::placed::{PlacedBounds, outline_bounds, placed_bounds};
use crate::numerics::cosine;
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::profile::Side;

/// Most halvings of a stretch: the parts are then 1e-3 of its length. Two common tangents that are closer
/// enclose a dip of less than 1e-12 mm in a noise of micrometres.
const DEEPEST: u32 = 10;

/// Most pairs of parts looked at for two elements: only curves that nearly agree all along need so many, and
/// more of their places of least gap cannot be told apart.
const MOST_PARTS: u32 = 512;

/// Number of halvings after which two parts are tested for being one curve: pairs that differ seldom come so
/// far, and the test costs as much as looking at ten parts.
const AGREE_AT: u32 = 6;

/// Most Newton steps: from a bounded start it takes three to five.
const NEWTON_STEPS: u32 = 12;

/// Largest difference of the sines of two tangents that count as equal.
pub(super) const SAME_TANGENT: f64 = 2.0 * LEAST_KINK;

/// A part of an element, placed in the rail's axes.
#[derive(Clone, Copy)]
struct StretchPart {
    /// Range of the parameter.
    range: Interval,
    /// Parameter of the middle.
    middle: f64,
    /// Point at the middle: of the wheel's outline, or of the rail.
    place: ElementPoint,
    /// Bounds in the rail's axes.
    placed: PlacedBounds,
    /// Least and largest curvature \[1/mm\]: of the wheel's outline where it is seen, or of the rail.
    curvature: Interval,
    /// Number of halvings so far.
    depth: u32,
}

/// Two elements while they are solved.
struct StretchPair<'s, 'a> {
    search: &'s mut Search<'a>,
    elements: [u32; 2],
    shapes: [&'a Element; 2],
    /// Both whole elements.
    wholes: [&'s StretchPart; 2],
    /// Number of pairs of parts that may still be looked at.
    parts_left: u32,
    /// Whether both elements have turned out to be one curve: their place of contact is then known.
    are_one: bool,
}

/// What the bounds of two parts tell about common tangents.
enum Verdict {
    /// There is no common tangent that counts.
    Nothing,
    /// There is at most one least gap; its abscissa is near this \[mm\].
    OneNear(f64),
    /// The bounds exclude nothing.
    Open,
}

/// Looks for contact of two elements. `placed` holds the bounds of the whole outline of the wheel's element, if they are known.
pub(super) fn meet(search: &mut Search, elements: [u32; 2], placed: Option<&PlacedBounds>) {
    let [above, below] = search.elements(elements);
    search.solves += 1;
    let Some((curvature, _)) = outline_bounds(search.attitude, &above.bounds) else { return };
    if flatter(curvature, below.bounds.curvature) {
        return;
    }
    let whole = |element: &Element, place, placed, curvature| {
        let range = element.range;
        StretchPart { range, middle: range.middle(), place, placed, curvature, depth: 0 }
    };
    let placed = placed.copied();
    let placed = placed
        .unwrap_or_else(|| placed_bounds(search.attitude, &above.bounds).widened(search.slack, SAME_TANGENT));
    let wheel = whole(above, search.attitude.outline_place(&above.middle), placed, curvature);
    let rail = whole(below, below.middle, PlacedBounds::rail(&below.bounds), below.bounds.curvature);
    let (shapes, wholes) = ([above, below], [&wheel, &rail]);
    let mut pair = StretchPair { search, elements, shapes, wholes, parts_left: MOST_PARTS, are_one: false };
    pair.refine(&wheel, &rail);
}

/// Returns the common tangent of two elements to which Newton's method leads from `start`; `None` if it is
/// beyond their ends.
pub(super) fn follow(search: &Search, elements: [u32; 2], start: [f64; 2]) -> Option<[Foot; 2]> {
    let shapes = search.elements(elements);
    newton(search, shapes, start, shapes.map(|element| element.range))
}

impl StretchPart {
    /// Returns whether there is at most one common tangent of this part of the wheel and a part of the rail,
    /// and it can only be a least gap.
    fn is_rounder(&self, rail: &Self) -> bool {
        self.curvature.low > rail.curvature.high
    }
}

/// Returns whether a part of the wheel is everywhere less curved than a part of the rail: a common tangent is
/// then a largest gap, not a least one.
fn flatter(wheel: Interval, rail: Interval) -> bool {
    let (above, below) = (wheel.high, rail.low);
    above < below && below - above > EQUAL_CURVATURES * (above.abs() + below.abs())
}

impl StretchPair<'_, '_> {
    /// Makes the part of an element over `range`; `None` if it has no outline.
    fn half(&self, side: Side, range: Interval, depth: u32) -> Option<StretchPart> {
        let (element, body) = (self.shapes[index(side)], self.search.bodies[index(side)]);
        let half = range.width() / 2.0;
        let middle = range.low + half;
        let own = element.place(&body.coefficients, middle);
        let bounds = match &element.shape {
            ElementCurve::Stretch(stretch) => {
                stretch.reach.around(&own.station, own.curvature, half, side, body.rounding)
            }
            ElementCurve::Arc(arc) => {
                let ends = range.ends().map(|sin| arc.at(sin, cosine(sin)));
                Bounds::of_arc(&ends, &own.station, element.bounds.curvature, side, body.rounding)
            }
            ElementCurve::Line => element.bounds,
        };
        let attitude = self.search.attitude;
        let (place, placed, curvature) = match side {
            Side::Wheel => {
                let place = attitude.outline_place(&own);
                let (curvature, fastest) = outline_bounds(attitude, &bounds)?;
                let mut placed = placed_bounds(attitude, &bounds).widened(self.search.slack, SAME_TANGENT);
                if let ElementCurve::Stretch(stretch) = &element.shape {
                    placed.narrow(place.station.x, half * stretch.reach.run * fastest + self.search.slack);
                }
                (place, placed, curvature)
            }
            Side::Rail => (own, PlacedBounds::rail(&bounds), bounds.curvature),
        };
        Some(StretchPart { range, middle, place, placed, curvature, depth })
    }

    fn refine(&mut self, wheel: &StretchPart, rail: &StretchPart) {
        let shared = wheel.placed.shared(&rail.placed);
        let ranges = [wheel.range, rail.range];
        match self.look(wheel, rail, shared) {
            Verdict::Nothing => return,
            Verdict::OneNear(x) => {
                let start = [towards(wheel, x, rail), towards(rail, x, wheel)];
                if let Some(feet) = newton(self.search, self.shapes, start, ranges) {
                    return self.offer(feet);
                }
                let ends = [self.ends(Side::Wheel, wheel), self.ends(Side::Rail, rail)];
                if let [Some(above), Some(below)] = ends {
                    let found = self.between_ends([wheel, rail], above, below);
                    return found.into_iter().for_each(|parameters| self.offer_at(parameters));
                }
            }
            Verdict::Open => {}
        }
        if wheel.depth + rail.depth == AGREE_AT
            && let Some(parameters) = self.agree(wheel, rail)
        {
            let [above, below] = self.wholes;
            self.are_one = true;
            return self.offer_at(self.agree(above, below).unwrap_or(parameters));
        }
        let halved = [self.length(Side::Wheel, wheel), self.length(Side::Rail, rail)];
        if self.parts_left == 0 || halved.iter().all(Option::is_none) {
            if let Some(feet) = newton(self.search, self.shapes, [wheel.middle, rail.middle], ranges) {
                self.offer(feet);
            }
            return;
        }
        if halved[0] >= halved[1] {
            for half in self.halves(Side::Wheel, wheel).into_iter().flatten() {
                self.further(&half, rail);
            }
        } else {
            for half in self.halves(Side::Rail, rail).into_iter().flatten() {
                self.further(wheel, &half);
            }
        }
    }

    /// Looks at two parts of which one is new, unless their bounds exclude contact.
    fn further(&mut self, wheel: &StretchPart, rail: &StretchPart) {
        if self.are_one {
            return;
        }
        self.search.solves += 1;
        self.parts_left = self.parts_left.saturating_sub(1);
        let bound = wheel.placed.gap_over(&rail.placed);
        if bound != f64::INFINITY
            && bound <= self.search.bound_ceiling()
            && !flatter(wheel.curvature, rail.curvature)
        {
            self.refine(wheel, rail);
        }
    }

    /// Returns a bound of the length of a part that can be halved \[mm\]; `None` if it cannot. The bounds of
    /// an arc leave nothing open, except the curvature of a yawed arc's outline.
    fn length(&self, side: Side, part: &StretchPart) -> Option<f64> {
        let placed = part.placed.x.width();
        let length = match &self.shapes[index(side)].shape {
            ElementCurve::Stretch(stretch) => {
                placed.max(part.range.width() * stretch.reach.run.hypot(stretch.reach.rise))
            }
            ElementCurve::Arc(_) if side == Side::Wheel && self.search.attitude.sin_yaw != 0.0 => placed,
            _ => return None,
        };
        (part.depth < DEEPEST).then_some(length)
    }

    fn halves(&self, side: Side, part: &StretchPart) -> [Option<StretchPart>; 2] {
        part.range.split(part.middle).map(|range| self.half(side, range, part.depth + 1))
    }

    /// Returns what the middles and curvatures of two parts tell about the abscissae at which the tangents
    /// can be equal.
    fn look(&self, wheel: &StretchPart, rail: &StretchPart, shared: Interval) -> Verdict {
        let (above, below) = (&wheel.place.station, &rail.place.station);
        if above.sin.is_nan() {
            return Verdict::Open;
        }
        let slack = self.search.slack;
        if rail.curvature.low == f64::NEG_INFINITY && rail.place.run == 0.0 {
            // The rail's part is a point.
            let there = reached(above.sin, wheel.curvature, below.x - above.x);
            return if apart(there, rail.placed.sine) {
                Verdict::Nothing
            } else {
                one_or_open(wheel, rail, below.x)
            };
        }
        let there = reached(below.sin, rail.curvature, above.x - below.x);
        if wheel.curvature.high == f64::INFINITY && wheel.place.run == 0.0 {
            // The part of an unyawed wheel is a point.
            return if apart(there, wheel.placed.sine) {
                Verdict::Nothing
            } else {
                Verdict::OneNear(above.x)
            };
        }
        // D = 0 at X, with D'(X − X_W) = the rail's sine at X_W less the wheel's.
        let missing = (there + -above.sin).grown(SAME_TANGENT);
        let slope = wheel.curvature + -rail.curvature;
        if wheel.is_rounder(rail) {
            let first = missing.low / if missing.low > 0.0 { slope.high } else { slope.low };
            let last = missing.high / if missing.high > 0.0 { slope.low } else { slope.high };
            let equal = (Interval::new(first, last) + above.x).cut(shared.grown(slack));
            if equal.is_empty() {
                return Verdict::Nothing;
            }
            // Where the tangents would be equal with the curvatures of both middles.
            let bends = [&wheel.place, &rail.place].map(|place| place.turn / place.run);
            let near =
                above.x + (below.sin - above.sin + bends[1] * (above.x - below.x)) / (bends[0] - bends[1]);
            return Verdict::OneNear(if near.is_nan() { equal.low } else { equal.nearest(near) });
        }
        let reach = (shared + -above.x).magnitude() + slack;
        let least = missing.nearest(0.0).abs();
        if least > reach * slope.magnitude() { Verdict::Nothing } else { Verdict::Open }
    }

    /// Returns the parameters in the middle of the shared abscissae if the two parts have the same tangents
    /// there, at both ends and half way to them: more places than two curves of a drawing share by chance.
    /// `None` with yaw.
    fn agree(&self, wheel: &StretchPart, rail: &StretchPart) -> Option<[f64; 2]> {
        let shared = wheel.placed.shared(&rail.placed);
        let same = |share: f64| {
            let x = shared.at(share);
            let parameters =
                [self.parameter_at(Side::Wheel, wheel, x), self.parameter_at(Side::Rail, rail, x)];
            let places = self.places(parameters);
            let differ = (places[0].1.station.sin - places[1].1.station.sin).abs();
            (differ <= SAME_TANGENT).then_some(parameters)
        };
        if self.search.attitude.sin_yaw != 0.0 {
            return None;
        }
        let middle = same(0.5)?;
        [0.0, 0.25, 0.75, 1.0].into_iter().all(|share| same(share).is_some()).then_some(middle)
    }

    /// Returns the parameters of the common tangent of two parts that have one at most; `None` unless the
    /// difference of their tangents changes sign between the ends of the abscissae that they share.
    ///
    /// `above` and `below` are the ranges of abscissae of the wheel's and the rail's part.
    fn between_ends(
        &self,
        [wheel, rail]: [&StretchPart; 2],
        above: Interval,
        below: Interval,
    ) -> Option<[f64; 2]> {
        let Interval { low, high } = above.cut(below);
        if low > high + self.search.slack {
            return None;
        }
        let parameters =
            |x: f64| [self.parameter_at(Side::Wheel, wheel, x), self.parameter_at(Side::Rail, rail, x)];
        let turn =
            |[p, q]: [f64; 2]| self.at(Side::Wheel, p).station.sin - self.at(Side::Rail, q).station.sin;
        let [above_is_point, below_is_point] = [above, below].map(|x| x.low == x.high);
        if above_is_point || below_is_point {
            // It takes the other's tangent.
            let [p, q] = parameters(low);
            let (point, other) = if below_is_point {
                (rail, self.at(Side::Wheel, p))
            } else {
                (wheel, self.at(Side::Rail, q))
            };
            let sin = other.station.sin;
            let inside = point.placed.sine.grown(SAME_TANGENT).contains(sin);
            let both = if below_is_point { [p, sin] } else { [sin, q] };
            return inside.then_some(both);
        }
        let ends = [low, high].map(parameters);
        let turns = ends.map(turn);
        if turns[0].abs() <= SAME_TANGENT {
            return Some(ends[0]);
        }
        if turns[1].abs() <= SAME_TANGENT {
            return Some(ends[1]);
        }
        (turns[0] < 0.0 && turns[1] > 0.0)
            .then(|| bracketed(|x| turn(parameters(x)), low, high))?
            .map(parameters)
    }

    /// Returns the abscissae between both ends of a part; `None` if one end of a yawed wheel's part has
    /// no outline.
    fn ends(&self, side: Side, part: &StretchPart) -> Option<Interval> {
        let [a, b] = part.range.ends().map(|p| self.at(side, p).station.x);
        a.partial_cmp(&b).map(|_| Interval::between(a, b))
    }

    /// Returns the point at a parameter, in the rail's axes.
    fn at(&self, side: Side, parameter: f64) -> ElementPoint {
        let own = self.shapes[index(side)].place(&self.search.bodies[index(side)].coefficients, parameter);
        if side == Side::Wheel { self.search.attitude.outline_place(&own) } else { own }
    }

    /// Returns the parameter at an abscissa of the rail's axes, or that of the nearer end, for a part whose
    /// abscissae are monotone.
    fn parameter_at(&self, side: Side, part: &StretchPart, x: f64) -> f64 {
        let at = |p: f64| {
            let place = self.at(side, p);
            [place.station.x, place.run]
        };
        let [a, b] = part.range.ends();
        let (first, last) = (at(a)[0], at(b)[0]);
        let ends = if first <= last { [a, b] } else { [b, a] };
        rising_root(ends, Interval::between(first, last), x, at)
    }

    /// Returns the points of both elements at two parameters, each in its own axes and in the rail's.
    fn places(&self, parameters: [f64; 2]) -> [(ElementPoint, ElementPoint); 2] {
        places(self.search, self.shapes, parameters)
    }

    fn offer_at(&mut self, parameters: [f64; 2]) {
        let [(wheel, _), (rail, _)] = self.places(parameters);
        let [above, below] = self.shapes;
        self.offer([foot(above, &wheel, parameters[0]), foot(below, &rail, parameters[1])]);
    }

    fn offer(&mut self, [wheel, rail]: [Foot; 2]) {
        self.search.offer(self.elements, &wheel, &rail);
    }
}

fn index(side: Side) -> usize {
    match side {
        Side::Wheel => 0,
        Side::Rail => 1,
    }
}

fn foot(element: &Element, own: &ElementPoint, parameter: f64) -> Foot {
    Foot { station: own.station, radius: element.radius(own), parameter }
}

/// Returns the bounds of a sine at a distance along x, from the bounds of the curvature on the way.
fn reached(sine: f64, curvature: Interval, distance: f64) -> Interval {
    let Interval { low, high } = curvature.map(|k| if distance == 0.0 { 0.0 } else { k * distance });
    Interval::of(low).with(high) + sine
}

fn apart(a: Interval, b: Interval) -> bool {
    a.low > b.high + SAME_TANGENT || b.low > a.high + SAME_TANGENT
}

fn one_or_open(wheel: &StretchPart, rail: &StretchPart, x: f64) -> Verdict {
    if wheel.is_rounder(rail) { Verdict::OneNear(x) } else { Verdict::Open }
}

/// Returns a parameter of a part to start from for an abscissa, by the part's tangent line; for a point, the
/// parameter with the other part's tangent.
fn towards(part: &StretchPart, x: f64, other: &StretchPart) -> f64 {
    let ElementPoint { station, run, turn, .. } = part.place;
    let step =
        if run == 0.0 { (other.place.station.sin - station.sin) / turn } else { (x - station.x) / run };
    let p = part.middle + step;
    if p.is_nan() { part.middle } else { p.clamp(part.range.low, part.range.high) }
}

fn places(search: &Search, shapes: [&Element; 2], [p, q]: [f64; 2]) -> [(ElementPoint, ElementPoint); 2] {
    let [wheel, rail] = shapes;
    let [above, below] = search.bodies;
    let own = wheel.place(&above.coefficients, p);
    let foot = rail.place(&below.coefficients, q);
    [(own, search.attitude.outline_place(&own)), (foot, foot)]
}

/// Solves for equal abscissae and equal sines of the tangents by Newton's method; `None` unless it settles
/// within the `limits` of both parameters, to the rounding of a joint.
fn newton(
    search: &Search,
    shapes: [&Element; 2],
    start: [f64; 2],
    limits: [Interval; 2],
) -> Option<[Foot; 2]> {
    let rounding = search.slack;
    let mut p = start;
    let mut settled = false;
    for _ in 0..NEWTON_STEPS {
        let [(own, above), (foot_place, below)] = places(search, shapes, p);
        let apart = [above.station.x - below.station.x, above.station.sin - below.station.sin];
        let turn = below.run * above.turn - above.run * below.turn;
        let step = [
            (apart[0] * below.turn - below.run * apart[1]) / turn,
            (above.turn * apart[0] - above.run * apart[1]) / turn,
        ];
        if !(step[0].is_finite() && step[1].is_finite()) {
            return None;
        }
        if settled {
            // The amount by which rounding of an abscissa, or a kink that counts as none, moves the place.
            let slack = [
                ((rounding * below.turn).abs() + (below.run * SAME_TANGENT).abs()) / turn.abs(),
                ((rounding * above.turn).abs() + (above.run * SAME_TANGENT).abs()) / turn.abs(),
            ];
            let inside = |k: usize| limits[k].grown(slack[k]).contains(p[k]);
            if apart[0].abs() <= rounding {
                return (inside(0) && inside(1))
                    .then(|| [foot(shapes[0], &own, p[0]), foot(shapes[1], &foot_place, p[1])]);
            }
        }
        settled = (above.run * step[0]).abs() + (below.run * step[1]).abs() <= rounding;
        for k in 0..2 {
            // Beyond its end an element is continued, but by no more than its own length.
            let farthest = limits[k].grown(limits[k].width());
            let next = (p[k] + step[k]).clamp(farthest.low, farthest.high);
            p[k] = if matches!(shapes[k].shape, ElementCurve::Arc(_)) { next.clamp(-1.0, 1.0) } else { next };
        }
    }
    None
}
