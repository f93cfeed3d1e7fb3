//! Free oracles: what must not change when nothing of substance does.
//!
//! Random chains come from generators that make near-tangent, near-equal and near-joint cases on purpose. The
//! seed is fixed and printed; a failure prints the shrunk case.

use crate::common::holds;
use proptest::prelude::*;
use wheelrail::Interval;
use wheelrail::load::feasibility;
use wheelrail::nalgebra::UnitComplex;
use wheelrail::patch::{Patch, Slicer, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Polynomial, Profile, Segment, Shape, Station, standards};
use wheelrail::separation::{Choice, Demand, EtaAxis, Evaluator, Method};

const CASES: u32 = 128;

/// Half the window in ξ and η \[mm\].
const REACH: [f64; 2] = [20.0, 15.0];

/// The promise: absolute error of s \[mm\] on radii up to 300 mm and 150 mm profiles; both sides of a comparison
/// may use it up. Over slopes it is the promise across the surface.
const PROMISED: f64 = 2e-12;

/// Points where a normal's ζ component is below this are left out of rounded comparisons: a rounding of the
/// profile's own coordinates is there worth a hundred of s.
const STEEP: f64 = 0.1;

// ------------------------------------------------------------------------------------------------ generators

/// How a segment bends.
#[derive(Debug, Clone, Copy)]
enum Bend {
    /// Signed radius \[mm\].
    Radius(f64),
    /// The radius before it, times 1 + this.
    AsBefore(f64),
    Line,
    /// Second and third coefficient about its beginning \[1/mm, 1/mm²\].
    Cubic(f64, f64),
}

#[derive(Debug, Clone, Copy)]
struct Link {
    run: f64,
    bend: Bend,
    /// tan of the kink before it.
    kink: f64,
}

#[derive(Debug, Clone)]
struct Chain {
    slope: f64,
    links: Vec<Link>,
}

/// A contact abscissa: a share of the chain, or next to a joint.
#[derive(Debug, Clone, Copy)]
enum At {
    Share(f64),
    Joint(usize, f64),
}

#[derive(Debug, Clone)]
struct Case {
    rail: Chain,
    wheel: Chain,
    wheel_radius: f64,
    contact: [At; 2],
    /// Shares of the window, and offsets from the joint nearest to it where given.
    points: Vec<([f64; 2], Option<f64>)>,
}

fn near_zero() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1e-12), Just(-1e-12), Just(1e-9), Just(-1e-9), Just(1e-6), Just(-1e-6)]
}

fn link() -> impl Strategy<Value = Link> {
    let run = prop_oneof![6 => 1.0..20.0, 1 => Just(1e-3), 1 => Just(1e-6)];
    let radius = (8.0..400.0f64, any::<bool>()).prop_map(|(r, up)| Bend::Radius(if up { -r } else { r }));
    let bend = prop_oneof![
        5 => radius,
        1 => Just(Bend::Radius(-1e4)),
        2 => near_zero().prop_map(Bend::AsBefore),
        1 => Just(Bend::Line),
        1 => (-0.02..0.02f64, -5e-4..5e-4f64).prop_map(|(a, b)| Bend::Cubic(a, b)),
    ];
    let kink = prop_oneof![4 => Just(0.0), 1 => near_zero(), 1 => -0.05..0.05];
    (run, bend, kink).prop_map(|(run, bend, kink)| Link { run, bend, kink })
}

fn chain() -> impl Strategy<Value = Chain> {
    (-0.4..0.4, prop::collection::vec(link(), 2..7)).prop_map(|(slope, links)| Chain { slope, links })
}

fn at() -> impl Strategy<Value = At> {
    prop_oneof![(0.2..0.8).prop_map(At::Share), (0..6usize, near_zero()).prop_map(|(k, d)| At::Joint(k, d))]
}

fn case() -> impl Strategy<Value = Case> {
    let points = prop::collection::vec(
        ([-1.0..1.0, -1.0..1.0], prop_oneof![2 => Just(None), 1 => near_zero().prop_map(Some)]),
        12,
    );
    // Every other wheel is its rail with nearly the same radii: closely conforming pairs.
    let like = prop_oneof![1 => Just(None), 1 => near_zero().prop_map(Some)];
    (chain(), chain(), like, 250.0..600.0, [at(), at()], points).prop_map(
        |(rail, wheel, like, wheel_radius, mut contact, points)| {
            let wheel = match like {
                Some(change) => {
                    contact[1] = contact[0];
                    rail.conforming(change)
                }
                None => wheel,
            };
            Case { rail, wheel, wheel_radius, contact, points }
        },
    )
}

impl Chain {
    /// The same with radii changed by a factor 1 + `change`.
    fn conforming(&self, change: f64) -> Self {
        let mut out = self.clone();
        for link in &mut out.links {
            if let Bend::Radius(r) = &mut link.bend {
                *r *= 1.0 + change;
            }
        }
        out
    }

    /// The segments, all lengths times `scale`; an arc that would get steep becomes a line.
    fn segments(&self, scale: f64) -> Vec<Segment> {
        let length: f64 = self.links.iter().map(|l| l.run).sum();
        let norm = self.slope.hypot(1.0);
        let mut x = -length / 2.0;
        let mut at = Station { x: x * scale, z: 0.25 * scale, cos: 1.0 / norm, sin: self.slope / norm };
        let mut radius = 300.0;
        let mut out = Vec::new();
        for link in &self.links {
            x += link.run;
            at = kinked(at, link.kink);
            let shape = match link.bend {
                Bend::Radius(r) => {
                    radius = r;
                    arc(at, radius * scale, x * scale)
                }
                Bend::AsBefore(change) => {
                    radius *= 1.0 + change;
                    arc(at, radius * scale, x * scale)
                }
                Bend::Line => None,
                Bend::Cubic(a, b) => cubic(at, [a / scale, b / (scale * scale)], x * scale),
            };
            let line = || Arc::tangent_at(at, f64::INFINITY, x * scale).expect("a rising x");
            let shape = shape.unwrap_or_else(|| Shape::Arc(line()));
            let segment = Segment { label: String::new(), shape };
            at = segment.end();
            out.push(segment);
        }
        out
    }

    fn profile(&self, scale: f64) -> Profile {
        Profile::new("chain", "generator", self.segments(scale)).expect("a chain without steps")
    }

    /// The contact abscissa, for scale 1.
    fn abscissa(&self, at: At) -> f64 {
        let ends: Vec<f64> = self.segments(1.0).iter().map(|s| s.end().x).collect();
        let [first, last] = [self.segments(1.0)[0].start().x, ends[ends.len() - 1]];
        match at {
            At::Share(share) => first + (last - first) * share,
            At::Joint(k, offset) => ends[k % (ends.len() - 1)] + offset,
        }
    }
}

fn kinked(at: Station, tan: f64) -> Station {
    let norm = tan.hypot(1.0);
    let (cos, sin) = ((at.cos - at.sin * tan) / norm, (at.sin + at.cos * tan) / norm);
    Station { cos, sin, ..at }
}

fn arc(at: Station, radius: f64, to_x: f64) -> Option<Shape> {
    let arc = Arc::tangent_at(at, radius, to_x).ok()?;
    (arc.end().cos > 0.3).then_some(Shape::Arc(arc))
}

fn cubic(at: Station, [a, b]: [f64; 2], to_x: f64) -> Option<Shape> {
    let (x, slope) = (at.x, at.sin / at.cos);
    let c = [
        at.z - slope * x + a * x * x - b * x * x * x,
        slope - 2.0 * a * x + 3.0 * b * x * x,
        a - 3.0 * b * x,
        b,
    ];
    let polynomial = Polynomial::graph(&c, [x, to_x]).ok()?;
    let flat = (0..=8).all(|k| polynomial.station(polynomial.range().at(f64::from(k) / 8.0)).cos > 0.3);
    // A span of a nm holds a polynomial that has lost its digits: a drawing has no such thing.
    (flat && to_x - x > 1e-5 * x.abs()).then_some(Shape::Polynomial(polynomial))
}

impl Case {
    fn abscissae(&self) -> [f64; 2] {
        [self.rail.abscissa(self.contact[0]), self.wheel.abscissa(self.contact[1])]
    }

    /// Whether rounding cannot carry a contact point from one segment to the next.
    fn contacts_off_joints(&self) -> bool {
        let [rail_x, wheel_x] = self.abscissae();
        let off = |chain: &Chain, x: f64| chain.segments(1.0).iter().all(|s| (s.end().x - x).abs() > 1e-8);
        off(&self.rail, rail_x) && off(&self.wheel, wheel_x)
    }

    fn placed(&self, rail: Profile, wheel: Profile, scale: f64, skew: f64) -> Placement {
        let [rail_x, wheel_x] = self.abscissae();
        let pair = Pair::new(rail, wheel, self.wheel_radius * scale).expect("a pair");
        pair.placed(rail_x * scale, wheel_x * scale, skew).expect("a contact on both chains")
    }

    fn placement(&self, scale: f64, skew: f64) -> Placement {
        self.placed(self.rail.profile(scale), self.wheel.profile(scale), scale, skew)
    }

    /// (ξ, η) of the case, some of them next to joints.
    fn points(&self, placement: &Placement) -> Vec<[f64; 2]> {
        let joints = placement.joints(-REACH[0], REACH[0]);
        let point = |&([a, b], near): &([f64; 2], Option<f64>)| {
            let xi = a * REACH[0];
            let nearest = joints.iter().min_by(|p, q| (*p - xi).abs().total_cmp(&(*q - xi).abs()));
            let xi = near.zip(nearest).map_or(xi, |(offset, joint)| joint + offset);
            [xi, b * REACH[1]]
        };
        let mut points: Vec<_> = self.points.iter().map(point).collect();
        points.extend([[0.0, 0.0], [1e-6, 0.0], [1e-3, -1e-3]]);
        points
    }

    /// What two evaluations of s may differ by \[mm\] on this pair.
    fn allowed(&self) -> f64 {
        let radii = self.rail.links.iter().chain(&self.wheel.links).map(|l| match l.bend {
            Bend::Radius(r) => r.abs(),
            _ => 300.0,
        });
        2.0 * PROMISED * radii.fold(1.0, |m, r| f64::max(m, r / 300.0))
    }
}

fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

/// s and both normals.
fn evaluated(placement: &Placement, [xi, eta]: [f64; 2]) -> [f64; 7] {
    let mut evaluator = Evaluator::new(placement);
    let n = evaluator.normals(xi, eta);
    let [a, b] = [n.rail, n.wheel].map(|n| n.map_or([f64::NAN; 3], |n| n.into_inner().into()));
    [evaluator.separation(xi, eta), a[0], a[1], a[2], b[0], b[1], b[2]]
}

/// Compares s of two placements at corresponding points, where neither is steep nor right at a joint.
fn compare(
    one: &Placement,
    other: &Placement,
    points: &[[f64; 2]],
    moved: impl Fn([f64; 2]) -> [f64; 2],
    allowed: f64,
) -> Result<(), TestCaseError> {
    for &point in points {
        let (a, b) = (evaluated(one, point), evaluated(other, moved(point)));
        let flattest = a[3].abs().min(a[6].abs());
        let at_end = a[0].is_nan() != b[0].is_nan() && near_end(one, point[0]);
        if flattest < STEEP || at_end {
            continue;
        }
        let close = (a[0] - b[0]).abs() <= allowed / flattest || same(a[0], b[0]);
        prop_assert!(close, "s{point:?} = {:e}, moved {:e}, apart {:e}", a[0], b[0], a[0] - b[0]);
    }
    Ok(())
}

/// Whether ξ is within rounding of where the overlap of the bodies ends.
fn near_end(placement: &Placement, xi: f64) -> bool {
    let ends = placement.overlap().map(Interval::ends);
    ends.iter().flatten().any(|end| (xi - end).abs() < 1e-6) || xi.abs() > REACH[0] - 1.0
}

// ------------------------------------------------------------------------------------------------ properties

#[test]
fn scaling_all_lengths_gives_the_same_bits() {
    let powers = prop_oneof![Just(1), Just(-1), Just(3), Just(-5), Just(20), Just(-20)];
    let skew = prop_oneof![Just(0.0), Just(0.01), -0.05..0.05];
    holds("scaling", CASES, (case(), powers, skew), |(case, power, skew)| {
        let scale = 4f64.powi(power);
        let (one, other) = (case.placement(1.0, skew), case.placement(scale, skew));
        for point in case.points(&one) {
            let (a, b) = (evaluated(&one, point), evaluated(&other, point.map(|v| v * scale)));
            prop_assert!(same(a[0] * scale, b[0]), "s{point:?} = {:e}, scaled {:e}", a[0], b[0] / scale);
            prop_assert!((1..7).all(|k| same(a[k], b[k])), "normals at {point:?}: {a:?}, scaled {b:?}");
        }
        Ok(())
    });
}

#[test]
fn scaling_keeps_the_bits_of_columns_feasibility_and_boundary() {
    let powers = prop_oneof![Just(1), Just(-2), Just(20), Just(-20)];
    let skew = prop_oneof![3 => Just(0.0), 1 => Just(0.01)];
    holds(
        "scaling of the rest",
        CASES,
        (case(), powers, skew, 1e-3..0.1f64),
        |(case, power, skew, approach)| {
            let scale = 4f64.powi(power);
            let (one, other) = (case.placement(1.0, skew), case.placement(scale, skew));
            let (a, b) = (feasibility(&one), feasibility(&other));
            prop_assert_eq!(a.map(|f| f.feasible), b.map(|f| f.feasible));
            prop_assert_eq!(a.map(|f| f.at_xi_mm * scale), b.map(|f| f.at_xi_mm));
            prop_assert_eq!(a.map(|f| f.least_separation_mm * scale), b.map(|f| f.least_separation_mm));
            let points = case.points(&one);
            let mut slicers = [Slicer::new(&one, approach), Slicer::new(&other, approach * scale)];
            for [xi, _] in &points {
                let [a, b] = [slicers[0].slice(*xi), slicers[1].slice(xi * scale)];
                prop_assert_eq!(a.map(|s| s.eta.map(|eta| eta * scale)), b.map(|s| s.eta), "slice at {}", xi);
            }
            let columns = |placement: &Placement, scale: f64| {
                let mut eta: Vec<f64> = points.iter().map(|p| p[1] * scale).collect();
                eta.sort_by(f64::total_cmp);
                let demand = Demand { absolute: 1e-9 * scale, relative: f64::INFINITY };
                let choice = Choice { method: Method::Spectral, demand, coefficients: 1 };
                let xi: Vec<f64> = points.iter().map(|p| p[0] * scale).collect();
                let mut out = vec![0.0; xi.len() * eta.len()];
                choice.fill(placement, &xi, &EtaAxis::new(&eta), &mut out);
                out
            };
            let (a, b) = (columns(&one, 1.0), columns(&other, scale));
            for (k, (a, b)) in a.iter().zip(&b).enumerate() {
                prop_assert!(
                    same(a * scale, *b),
                    "column {}: {a:e}, scaled {:e}",
                    k / points.len(),
                    b / scale
                );
            }
            Ok(())
        },
    );
}

#[test]
fn scaling_keeps_the_bits_of_the_patch() {
    let powers = prop_oneof![Just(1), Just(-2), Just(20), Just(-20)];
    holds("scaling of the patch", CASES, (case(), powers, 1e-3..0.1f64), |(case, power, approach)| {
        let scale = 4f64.powi(power);
        let (one, other) = (case.placement(1.0, 0.0), case.placement(scale, 0.0));
        let patch = |placement: &Placement, scale: f64| {
            let window =
                Window { xi: Interval::symmetric(20.0 * scale), eta: Interval::symmetric(15.0 * scale) };
            Patch::new(placement, approach * scale, &window)
        };
        let (a, b) = (patch(&one, 1.0), patch(&other, scale));
        prop_assert_eq!(a.components.len(), b.components.len());
        for (a, b) in a.components.iter().zip(&b.components) {
            prop_assert_eq!(a.xi.map(|x| x * scale), b.xi);
            prop_assert_eq!(a.ends, b.ends);
            prop_assert_eq!(a.boundary.len(), b.boundary.len());
            for (p, q) in a.boundary.iter().zip(&b.boundary) {
                prop_assert_eq!(p.map(|v| v * scale), *q);
            }
            prop_assert!(
                same(a.area * scale * scale, b.area),
                "area {} and {}",
                a.area,
                b.area / scale / scale
            );
            prop_assert!(same(a.perimeter * scale, b.perimeter));
        }
        Ok(())
    });
}

#[test]
fn a_mirrored_pair_has_the_mirrored_separation() {
    let skew = prop_oneof![Just(0.0), Just(0.02)];
    holds("mirror", CASES, (case(), skew), |(case, skew)| {
        let one = case.placement(1.0, skew);
        let pair =
            Pair::new(one.rail().profile().mirrored(), one.wheel().profile().mirrored(), one.wheel_radius());
        let [rail_x, wheel_x] = case.abscissae();
        let other = pair.and_then(|pair| pair.placed(-rail_x, -wheel_x, -skew)).expect("the mirrored pair");
        // At a joint the left neighbour counts, whose tangent may differ: then it is another contact.
        prop_assume!(case.contacts_off_joints());
        compare(&one, &other, &case.points(&one), |[xi, eta]| [-xi, eta], case.allowed())
    });
}

#[test]
fn reversing_a_chain_twice_changes_nothing() {
    holds("reversal", CASES, case(), |case| {
        for chain in [&case.rail, &case.wheel] {
            let profile = chain.profile(1.0);
            prop_assert_eq!(&profile.mirrored().mirrored(), &profile);
        }
        Ok(())
    });
}

#[test]
fn splitting_arcs_changes_nothing() {
    holds("splitting", CASES, (case(), 0.05..0.95f64), |(case, share)| {
        let one = case.placement(1.0, 0.0);
        let split = |profile: &Profile| {
            let halves = profile.segments().iter().flat_map(|segment| halves(segment, share)).collect();
            Profile::new("split", "generator", halves).expect("the same chain")
        };
        let other = case.placed(split(one.rail().profile()), split(one.wheel().profile()), 1.0, 0.0);
        compare(&one, &other, &case.points(&one), |p| p, case.allowed())
    });
}

/// The two parts of an arc, or the segment as it is.
fn halves(segment: &Segment, share: f64) -> Vec<Segment> {
    let Shape::Arc(arc) = &segment.shape else { return vec![segment.clone()] };
    let middle = arc.start().x + (arc.end().x - arc.start().x) * share;
    let Ok(first) = Arc::tangent_at(arc.start(), arc.radius(), middle) else { return vec![segment.clone()] };
    let Ok(second) = Arc::tangent_at(first.end(), arc.radius(), arc.end().x) else {
        return vec![segment.clone()];
    };
    vec![Segment::arc(first), Segment::arc(second)]
}

#[test]
fn a_rigid_motion_of_the_profiles_changes_nothing() {
    let motion = (-0.6..0.6f64, -300.0..300.0f64, -50.0..50.0f64, -300.0..300.0f64, -20.0..20.0f64);
    holds("rigid motion", CASES, (case(), motion), |(case, (angle, x, z, wheel_x, wheel_z))| {
        let one = case.placement(1.0, 0.0);
        let turn = UnitComplex::new(angle);
        let rail = one.rail().profile().rotated(turn).shifted(x, z);
        // The wheel may only move along its axle, and with it.
        let wheel = one.wheel().profile().shifted(wheel_x, wheel_z);
        let c = one.rail().point().station;
        let turned = c.placed_by(&Station { x, z, cos: turn.re, sin: turn.im });
        prop_assume!(turned.cos > STEEP);
        // A point next to a joint may come to lie on its other side.
        prop_assume!(case.contacts_off_joints());
        let pair = Pair::new(rail, wheel, one.wheel_radius() + wheel_z).expect("a pair");
        let placed = pair.placed(turned.x, one.wheel().point().station.x + wheel_x, 0.0);
        let other = placed.expect("the same contact");
        // C itself is rounded at coordinates of up to 300 mm, and with it the frame.
        let frame = 64.0 * f64::EPSILON * 300.0;
        let slope = points_slope(&case);
        compare(&one, &other, &case.points(&one), |p| p, case.allowed() + frame * (1.0 + slope))
    });
}

/// How far the frame turns per mm that C moves, times the window: the sharpest curvature × reach.
fn points_slope(case: &Case) -> f64 {
    let links = case.rail.links.iter().chain(&case.wheel.links);
    links.map(|l| if let Bend::Radius(r) = l.bend { REACH[0] / r.abs() } else { 1.0 }).fold(1.0, f64::max)
}

#[test]
fn the_other_side_of_the_midplane_is_the_same_to_the_bit() {
    holds("η → −η", CASES, (case(), -0.05..0.05f64), |(case, skew)| {
        for skew in [0.0, skew] {
            let (one, other) = (case.placement(1.0, skew), case.placement(1.0, -skew));
            for [xi, eta] in case.points(&one) {
                let (a, b) = (evaluated(&one, [xi, eta]), evaluated(&other, [xi, -eta]));
                prop_assert!(same(a[0], b[0]), "s({xi}, ±{eta}) = {:e}, {:e}", a[0], b[0]);
                prop_assert!([1, 3, 4, 6].iter().all(|&k| same(a[k], b[k])) && same(a[5], -b[5]));
            }
        }
        Ok(())
    });
}

#[test]
fn a_larger_approach_contains_the_smaller_patch() {
    let deltas = (1e-4..0.1f64, prop_oneof![Just(1e-12), Just(1e-6), 1e-3..1.0f64]);
    holds(
        "larger δ",
        CASES,
        (case(), deltas, prop_oneof![Just(0.0), Just(0.02)]),
        |(case, (delta, more), skew)| {
            let placement = case.placement(1.0, skew);
            let mut slicers = [delta, delta * (1.0 + more)].map(|delta| Slicer::new(&placement, delta));
            for [xi, _] in case.points(&placement) {
                let [small, large] = [slicers[0].slice(xi), slicers[1].slice(xi)];
                let Some(small) = small else { continue };
                let large =
                    large.ok_or_else(|| TestCaseError::fail(format!("no slice at ξ = {xi} any more")))?;
                let inside = large.eta[0] <= small.eta[0] && small.eta[1] <= large.eta[1];
                prop_assert!(inside, "at ξ = {xi}: {small:?} not in {large:?}");
            }
            Ok(())
        },
    );
}

/// An angle moves the surfaces in proportion: nothing jumps when a side face becomes vertical to rounding.
#[test]
fn a_last_digit_of_an_inclination_moves_s_by_as_much() {
    let wheel = standards::wheel("S1002").expect("built in");
    // How far 1 rad moves points of the head, C among them, and with C the frame over the window [mm].
    let lever = 1e3;
    for name in standards::rail_names() {
        let rail = standards::rail(name).expect("built in");
        let placed = |angle: f64| {
            let pair =
                Pair::new(rail.rotated(UnitComplex::new(angle)), wheel.clone(), 460.0).expect("a pair");
            pair.placed(0.0, 0.0, 0.01).expect("points of both")
        };
        for angle in [20f64.recip().atan(), -(20f64.recip().atan()), 40f64.recip().atan(), 0.05, 0.0] {
            let base = placed(angle);
            for change in [-1e-9, -1e-12, -1e-15, -2e-17, 7e-18, 2e-17, 1e-16, 1e-14, 1e-11] {
                let other = placed(angle + change);
                let mut evaluators = [&base, &other].map(Evaluator::new);
                for xi in [-30.0, -12.0, -1.0, 0.0, 3.0, 25.0, 31.0] {
                    for eta in [0.0, -7.0, 15.0] {
                        let [a, b] = evaluators.each_mut().map(|e| e.separation(xi, eta));
                        let allowed = 2.0 * PROMISED + lever * change.abs();
                        // Light rails end before 30 mm.
                        let nowhere = a.is_nan() && b.is_nan();
                        assert!(
                            nowhere || (a - b).abs() <= allowed,
                            "{name} {angle} {change:e}: s({xi}, {eta}) = {a}, {b}"
                        );
                    }
                }
            }
        }
    }
}
