//! Flange backs that rest on wing rails and guard rails: random rails of two heads against brute force in space.

use crate::in_time::InTime;
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Arc, Profile, Segment};
use wheelrail::search::Contact;
use wheelrail::{Evaluator, ONE_CONTACT, Pose, ProfilePair, Selection, feasibility};

use super::campaign;

/// Largest difference from brute force \[mm\].
const AGREED: f64 = 1e-6;

/// Approach of the patches \[mm\].
const APPROACH: f64 = 0.05;

/// A number in \[0, 1) from a state that moves on.
fn next(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

fn between(state: &mut u64, from: f64, to: f64) -> f64 {
    from + (to - from) * next(state)
}

/// A chain of lines by ascending x.
struct Lines(Vec<[f64; 2]>);

impl Lines {
    /// Rounds the corners of a chain over this length \[mm\] on either side.
    fn rounded(corners: &[[f64; 2]], length: f64) -> Self {
        let mut points = vec![corners[0]];
        for three in corners.windows(3) {
            let [a, b, c] = [three[0], three[1], three[2]];
            let beside = |p: [f64; 2]| {
                let share = (length / (p[0] - b[0]).hypot(p[1] - b[1])).min(0.45);
                [0, 1].map(|k| b[k] + share * (p[k] - b[k]))
            };
            let (from, to) = (beside(a), beside(c));
            points.extend((0..=6).map(|k| f64::from(k) / 6.0).map(|t| {
                [0, 1].map(|k| (1.0 - t) * (1.0 - t) * from[k] + 2.0 * t * (1.0 - t) * b[k] + t * t * to[k])
            }));
        }
        points.push(corners[corners.len() - 1]);
        Self(points)
    }

    fn profile(&self, name: &str) -> Profile {
        let line = |p: &[[f64; 2]]| Segment::arc(Arc::line(p[0], p[1]).expect("a line"));
        Profile::new(name, "random", self.0.windows(2).map(line).collect()).expect("a chain")
    }

    /// The height at x, or `None` beside the chain.
    fn height(&self, x: f64) -> Option<f64> {
        let k = self.0.partition_point(|p| p[0] < x).checked_sub(1)?;
        let ([a, b], [c, d]) = (self.0[k], *self.0.get(k + 1)?);
        Some(b + (d - b) * (x - a) / (c - a))
    }

    /// Points on the chain at most `spacing` apart.
    fn dense(&self, spacing: f64) -> impl Iterator<Item = [f64; 2]> {
        self.0.windows(2).flat_map(move |p| {
            let n = ((p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]) / spacing).ceil();
            (0..=n as u32).map(move |k| [0, 1].map(|i| p[0][i] + (p[1][i] - p[0][i]) * f64::from(k) / n))
        })
    }
}

/// A rail with a wing or guard on its left, and a wheel.
struct Scene {
    /// Corners of the rail, and how far they are rounded \[mm\].
    corners: [[f64; 2]; 9],
    rounding: f64,
    rail: Lines,
    wheel: Lines,
    radius: f64,
    /// Right edge of the wing \[mm\].
    edge: f64,
}

impl Scene {
    fn random(state: &mut u64) -> Self {
        let edge = -36.0 - between(state, 38.0, 60.0);
        let (top, depth) = (between(state, -6.0, 9.0), between(state, 34.0, 50.0));
        let (flank, face) = (between(state, 0.7, 6.0), between(state, 0.7, 5.0));
        let width = between(state, 30.0, 70.0);
        let corners = [
            [edge - width - 3.0, top - 30.0],
            [edge - width, top],
            [edge, top],
            [edge + flank, -depth],
            [-36.0 - face, -depth],
            [-36.0, -2.0],
            [0.0, 0.0],
            [36.0, -2.0],
            [38.0, -30.0],
        ];
        let (back, tip) = (between(state, 0.3, 4.0), between(state, -30.0, -26.0));
        let wheel = [
            [-70.0, between(state, -4.0, 8.0)],
            [-70.0 + back, tip + 4.0],
            [-60.0, tip],
            [-50.0, tip + 1.0],
            [-45.0, -20.0],
            [-37.0, -2.0],
            [-20.0, -0.5],
            [60.0, 2.0],
        ];
        let rounding = between(state, 2.0, 9.0);
        Self {
            corners,
            rounding,
            rail: Lines::rounded(&corners, rounding),
            wheel: Lines::rounded(&wheel, 3.0),
            radius: between(state, 300.0, 600.0),
            edge,
        }
    }

    /// The same scene with a flangeway whose bottom is narrower by a share.
    fn narrowed(mut self, share: f64) -> Self {
        let by = share * (self.corners[4][0] - self.corners[3][0]);
        self.corners[4..].iter_mut().for_each(|corner| corner[0] -= by);
        self.rail = Lines::rounded(&self.corners, self.rounding);
        self
    }

    fn pair(&self) -> Pair {
        let (rail, wheel) = (self.rail.profile("two heads"), self.wheel.profile("wheel"));
        Pair::new(rail, wheel, self.radius).expect("a pair")
    }
}

/// The bodies of a placed pair in space: all that brute force knows of them.
struct Space<'a> {
    scene: &'a Scene,
    /// (x, z, cosθ, sinθ) of C on the rail and on the wheel.
    at: [[f64; 4]; 2],
    /// (cosχ, sinχ).
    skew: [f64; 2],
}

impl<'a> Space<'a> {
    fn new(scene: &'a Scene, placement: &Placement) -> Self {
        let at = [placement.rail(), placement.wheel()].map(|body| {
            let p = body.point().station;
            [p.x, p.z, p.cos, p.sin]
        });
        Self { scene, at, skew: [placement.skew().cos(), placement.skew().sin()] }
    }

    /// (x, z) of a point of the contact frame in the rail's axes.
    fn on_rail(&self, [xi, _, zeta]: [f64; 3]) -> [f64; 2] {
        let [x, z, cos, sin] = self.at[0];
        [x + xi * cos - zeta * sin, z + xi * sin + zeta * cos]
    }

    /// (x, z) of the wheel's profile on whose circle a point of the contact frame lies.
    fn on_wheel(&self, [xi, eta, zeta]: [f64; 3]) -> [f64; 2] {
        let ([x, z, cos, sin], [c, s]) = (self.at[1], self.skew);
        let (along, across) = (xi * c + eta * s, eta * c - xi * s);
        let axle = self.scene.radius - (z + along * sin + zeta * cos);
        [x + along * cos - zeta * sin, self.scene.radius - axle.hypot(across)]
    }

    /// Depth of a point inside the wheel along its own z \[mm\]; negative outside.
    fn in_wheel(&self, point: [f64; 3]) -> f64 {
        let [x, z] = self.on_wheel(point);
        self.scene.wheel.height(x).map_or(f64::NEG_INFINITY, |surface| z - surface)
    }

    /// ζ of the wheel's lowest sheet \[mm\], looked for at steps of `step`, and x on its profile.
    fn wheel_sheet(&self, xi: f64, eta: f64, step: f64) -> Option<[f64; 2]> {
        let inside = |zeta: f64| self.in_wheel([xi, eta, zeta]) >= 0.0;
        let count = (80.0 / step) as u32;
        let first = (0..count).map(|k| -20.0 + step * f64::from(k)).find(|zeta| inside(*zeta))?;
        let (mut out, mut within) = (first - step, first);
        for _ in 0..60 {
            let middle = out + (within - out) / 2.0;
            *(if inside(middle) { &mut within } else { &mut out }) = middle;
        }
        Some([within, self.on_wheel([xi, eta, within])[0]])
    }

    /// ζ of the first surface of the rail that a line from `from` down meets \[mm\].
    fn rail_below(&self, xi: f64, from: f64) -> Option<f64> {
        let [x, z, cos, sin] = self.at[0];
        let own = |p: [f64; 2]| {
            let [dx, dz] = [p[0] - x, p[1] - z];
            [dx * cos + dz * sin, dz * cos - dx * sin]
        };
        let crossings = self.scene.rail.0.windows(2).filter_map(|p| {
            let ([a, b], [c, d]) = (own(p[0]), own(p[1]));
            let inside = a.min(c) <= xi && xi <= a.max(c);
            inside.then(|| b + (d - b) * (xi - a) / (c - a))
        });
        crossings.filter(|zeta| *zeta <= from + AGREED).max_by(f64::total_cmp)
    }

    /// s between the sheets that face each other \[mm\], if the wheel's is its flange.
    fn separation(&self, xi: f64, eta: f64, step: f64) -> Option<f64> {
        let [wheel, x] = self.wheel_sheet(xi, eta, step)?;
        // The wall in which the wheel's chain ends is no surface.
        let flange = x > -70.0 + AGREED && x < -40.0;
        Some(wheel - self.rail_below(xi, wheel).filter(|_| flange)?)
    }

    /// Least vertical distance between the bodies \[mm\], over points on circles of the wheel at most 1 mm apart.
    fn least_gap(&self, turns: u32) -> f64 {
        let ([x, z, cos, sin], [c, s]) = (self.at[1], self.skew);
        let mut least = f64::INFINITY;
        for [px, pz] in self.scene.wheel.dense(0.25) {
            let rho = self.scene.radius - pz;
            for k in 0..=2 * turns {
                let v = (f64::from(k) / f64::from(turns.max(1)) - 1.0) * if turns == 0 { 0.0 } else { 0.2 };
                let (dx, dz) = (px - x, self.scene.radius - rho * v.cos() - z);
                let (along, across, zeta) = (dx * cos + dz * sin, rho * v.sin(), dz * cos - dx * sin);
                let [rx, rz] = self.on_rail([along * c - across * s, 0.0, zeta]);
                least = self.scene.rail.height(rx).map_or(least, |height| least.min(rz - height));
            }
        }
        if turns == 0 {
            // Edges of the rail inside the wheel.
            for [px, pz] in self.scene.rail.dense(0.25) {
                let [rx, rz, rcos, rsin] = self.at[0];
                let (dx, dz) = (px - rx, pz - rz);
                let inside = self.in_wheel([dx * rcos + dz * rsin, 0.0, dz * rcos - dx * rsin]);
                least = least.min(-inside);
            }
        }
        least
    }
}

/// Draws until a wheel rests on a wing with its flange back.
fn resting(state: &mut u64, yawed: bool) -> (Scene, Placement, Contact) {
    for _ in 0..200 {
        let scene = Scene::random(state);
        let offset = scene.edge + 70.0 - between(state, -2.0, 9.0);
        let yaw = if yawed { between(state, -0.03, 0.03) } else { 0.0 };
        let pair = scene.pair();
        let search = ProfilePair::new(&pair).expect("a pair with surfaces");
        let pose = Pose::new(offset, yaw, between(state, -0.01, 0.01)).expect("small angles");
        let mut search = search.search();
        let touch = search.touch(&pose, &Selection { within: 0.0, apart: ONE_CONTACT });
        if let Some(contact) = touch.ok().map(|touch| touch.contacts[0]).filter(|c| c.contact_angle < -0.5) {
            return (scene, contact.placed(&pair).expect("a placed pair"), contact);
        }
    }
    panic!("no flange back on a wing in 200 scenes");
}

#[test]
fn flange_backs_on_wings_and_guards_are_feasible_with_the_patch_of_their_own_flank() {
    let (mut state, mut compared, mut reaching) = (20, 0, 0);
    for number in 0..campaign::scenes() {
        let _in_time = InTime::begin();
        let (scene, placement, _) = resting(&mut state, number % 2 == 1);
        let space = Space::new(&scene, &placement);
        let at = format!("scene {number}, {:?}, χ = {}", space.at, placement.skew());
        assert!(space.least_gap(200) >= -AGREED, "{at}: brute force overlaps by {}", -space.least_gap(200));
        let found = feasibility(&placement).expect("bodies over each other");
        assert!(found.feasible && found.least_separation_mm.abs() <= AGREED, "{at}: {found:?}");
        let patch = Patch::new(&placement, APPROACH, &Window::UNBOUNDED);
        assert!(!patch.components.is_empty(), "{at}: no patch");
        let mut evaluator = Evaluator::new(&placement);
        let mut compare = |xi: f64, eta: f64| {
            let s = evaluator.separation(xi, eta);
            if s.is_nan() {
                return;
            }
            let agrees = |step| space.separation(xi, eta, step).map(|brute| (s - brute).abs() <= AGREED);
            // Coarse steps pass over corners that a line cuts off.
            if let Some(agreed) = agrees(0.05) {
                let agreed = agreed || agrees(5e-4) != Some(false);
                assert!(agreed, "{at}: s({xi}, {eta}) = {s}, {:?}", space.separation(xi, eta, 5e-4));
                compared += 1;
            }
        };
        for component in &patch.components {
            let [s, xi, eta] = component.deepest;
            assert!(s >= -AGREED, "{at}: s = {s} at ({xi}, {eta})");
            compare(xi, eta);
        }
        for i in -6..=6 {
            for j in -3..=3 {
                compare(4.0 * f64::from(i), 12.0 * f64::from(j));
            }
        }
        // Would the outer sheets have been those of the other head?
        let [cos, sin] = [space.at[0][2], space.at[0][3]];
        let behind = [-36.0, 36.0].map(|x| (x - space.at[0][0]) * cos + (-2.0 - space.at[0][1]) * sin);
        reaching += u32::from(behind[1] < 30.0 && behind[0] > 0.0);
    }
    println!("{compared} separations compared; the other head is behind {reaching} flanges");
    assert!(compared >= 20 * campaign::scenes() && reaching > 0, "{compared} {reaching}");
}

#[test]
fn chosen_pairs_are_feasible_exactly_where_the_bodies_do_not_overlap() {
    let (mut state, mut counts) = (7, [0, 0]);
    for number in 0..2 * campaign::scenes() {
        // The flank at C stays; the other head comes nearer, and may reach into the flange from the front.
        let (scene, _, contact) = resting(&mut state, false);
        let scene = scene.narrowed(between(&mut state, 0.2, 0.95));
        let placement = contact.placed(&scene.pair()).expect("a placed pair");
        let gap = Space::new(&scene, &placement).least_gap(0);
        let found = feasibility(&placement).expect("bodies over each other");
        let at = format!("scene {number}: {gap} mm apart by brute force, {found:?}");
        assert_eq!(found.feasible, gap >= -AGREED, "{at}");
        assert_eq!(found.feasible, found.least_separation_mm >= -AGREED, "{at}");
        counts[usize::from(found.feasible)] += 1;
    }
    println!("{counts:?} infeasible and feasible");
    assert!(counts[0] > 2 && counts[1] > 2, "{counts:?}");
}
