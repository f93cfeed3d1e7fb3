//! Patches of random pairs against a flood fill of a fine grid: points, components, area, cut by the window; and automatic
//! grids, which never cut what they are for.

use crate::in_time::InTime;
use rayon::prelude::*;
use wheelrail::Interval;
use wheelrail::case::contacts;
use wheelrail::internal::Random;
use wheelrail::mesh;
use wheelrail::patch::{Component, End, Patch, Window};
use wheelrail::placement::{Pair, Placement};
use wheelrail::profile::{Profile, standards};
use wheelrail::scene;
use wheelrail::separation::{Choice, Demand, EtaAxis, Method};

/// Random pairs, as many as `WHEELRAIL_PATCHES` says instead; each seeded by its number.
const PAIRS: u64 = 3000;

/// Points of the first and of the finest grid on an axis.
const POINTS: [usize; 2] = [64, 512];

/// Factor by which a grid is finer that decides where the finest one does not: parts thinner than its cells.
const FINER: usize = 8;

/// Tolerance of the grid's values \[mm\], and of the judgement of a point.
const TOLERANCE: f64 = 1e-9;
const DOUBTFUL: f64 = 1e-8;

/// Largest relative error of the area, where the fill knows it better than that.
const AREA: f64 = 1e-3;

/// Share of the pairs for which the finest grid may leave open what is connected.
const UNDECIDED: f64 = 0.01;

/// A placed pair and what is asked of it.
pub struct Case {
    pub name: String,
    pub placement: Placement,
    pub approach: f64,
    pub window: Window,
    /// The method by which the grid is filled.
    pub method: Method,
}

impl Case {
    /// A wheel that is let down on a rail, or two points of them put together; `None` where they do not meet.
    fn new(number: u64) -> Option<Self> {
        let mut dice = Random::new(number);
        let rails: Vec<&str> = standards::rail_names().collect();
        let wheels: Vec<&str> = standards::wheel_names().collect();
        let (rail, wheel) = (*dice.pick(&rails), *dice.pick(&wheels));
        let inclination = *dice.pick(&["1:20", "1:40", "0.0"]);
        let radius = dice.between(200.0, 600.0);
        let approach = 10f64.powf(dice.between(-4.0, -0.3));
        let yaw = *dice.pick(&[0.0, 1.0, 1.0]) * dice.between(-0.08, 0.08) * dice.between(0.0, 1.0);
        let (placement, how) = if *dice.pick(&[true, true, false]) {
            let (offset, roll) = (dice.between(-9.0, 9.0), dice.between(-0.01, 0.01));
            let how = format!("offset {offset}, roll {roll}");
            let text = format!(
                "[rail]\nprofile = {rail:?}\nrotate = {}\n[wheel]\nprofile = {wheel:?}\nradius = {radius:?}\n\
                 [contact]\noffset = {offset:?}\nroll = {roll:?}\nyaw = {yaw:?}\n",
                if inclination == "0.0" { "0.0".into() } else { format!("{inclination:?}") }
            );
            let scene: scene::Scene = scene::parse(&text, false).expect("a scene");
            let case = scene::resolve(&scene, std::path::Path::new("."), "flood").expect("a case");
            (contacts(&case).ok()?.into_iter().next()?.1, how)
        } else {
            let profiles: [Profile; 2] =
                [standards::rail(rail), standards::wheel(wheel)].map(|profile| profile.expect("a profile"));
            let [r, w] = [dice.between(-36.0, 25.0), dice.between(-45.0, 30.0)];
            let [rail, wheel] = profiles;
            let pair = Pair::new(rail, wheel, radius).expect("a pair");
            (pair.placed(r, w, yaw).ok()?, format!("points {r}, {w}"))
        };
        let name = format!(
            "case {number}: {rail} at {inclination} under {wheel}, R {radius}, yaw {yaw}, {how}, δ {approach}"
        );
        // As wide as a patch of the usual curvatures, and some that cut it.
        let size = approach.sqrt() * *dice.pick(&[15.0, 40.0, 60.0]);
        let mut end = |sign: f64| sign * size * dice.between(0.3, 1.0);
        let window =
            Window { xi: Interval::new(end(-1.0), end(1.0)), eta: Interval::new(end(-1.0), end(1.0)) };
        Some(Self { name, placement, approach, window, method: Method::Spectral })
    }

    /// s − δ over a grid of n × n points, and its axes; infinite where a body has no surface.
    pub fn filled(&self, window: &Window, n: usize) -> Filled {
        let axis = |side: Interval| (0..n).map(|k| side.step(k, n - 1)).collect::<Vec<f64>>();
        let (xi, eta) = (axis(window.xi), axis(window.eta));
        let depth = self.depths(&xi, &eta);
        Filled { xi, eta, depth }
    }

    /// s − δ at the points of a grid; infinite where a body has no surface.
    fn depths(&self, xi: &[f64], eta: &[f64]) -> Vec<f64> {
        let mut s = vec![f64::NAN; xi.len() * eta.len()];
        let choice =
            Choice { method: self.method, demand: Demand::for_tolerance(TOLERANCE), coefficients: 3 };
        choice.fill(&self.placement, xi, &EtaAxis::new(eta), &mut s);
        // Without skew the patch is that over the midplane.
        let over = if self.placement.skew() == 0.0 {
            self.placement.overlap().unwrap_or(Interval::of(0.0))
        } else {
            Interval::ALL
        };
        let n = eta.len();
        s.iter_mut().enumerate().for_each(|(k, s)| {
            let seen = over.contains(xi[k / n]);
            *s = if s.is_nan() || !seen { f64::INFINITY } else { *s - self.approach };
        });
        s
    }

    /// Fills of a box around every component of the patch, and of one around the points inside that are in none of these, `finer` times
    /// as fine as the finest of the window; with the change of their area from grids half as fine.
    fn closer(&self, filled: &Filled, patch: &Patch, finer: usize) -> (Vec<Filled>, f64) {
        let wider = |side: Interval, most: Interval| side.grown(0.25 * side.width()).cut(most);
        let around =
            |c: &Component| Window { xi: wider(c.xi, self.window.xi), eta: wider(c.eta, self.window.eta) };
        let mut boxes: Vec<Window> = patch.components.iter().map(around).collect();
        let own = boxes.clone();
        let outside = |xi: f64, eta: f64| !own.iter().any(|window| window.contains(xi, eta));
        boxes.extend(filled.inside(&self.window, outside));
        while let Some((p, q)) = overlapping(&boxes) {
            let other = boxes.swap_remove(q);
            boxes[p] = boxes[p].hull(other);
        }
        let [coarse, fine] = [1, 2].map(|n| -> Vec<Filled> {
            boxes.iter().map(|box_of| self.filled(box_of, n * finer * POINTS[1] / 2)).collect()
        });
        let change = (area_of(&fine) - area_of(&coarse)).abs();
        (fine, change)
    }
}

fn area_of(fills: &[Filled]) -> f64 {
    fills.iter().map(Filled::area).sum()
}

/// Two boxes with points in common; the second has the larger index.
fn overlapping(boxes: &[Window]) -> Option<(usize, usize)> {
    let pairs = (1..boxes.len()).flat_map(|q| (0..q).map(move |p| (p, q)));
    pairs.into_iter().find(|&(p, q)| boxes[p].meets(&boxes[q]))
}

/// s − δ over a grid.
pub struct Filled {
    pub xi: Vec<f64>,
    pub eta: Vec<f64>,
    pub depth: Vec<f64>,
}

impl Filled {
    fn at(&self, i: usize, j: usize) -> f64 {
        self.depth[i * self.eta.len() + j]
    }

    /// Area by straight lines between the points of every column \[mm²\].
    fn area(&self) -> f64 {
        let (n, m) = (self.xi.len(), self.eta.len());
        let (dx, dy) = (self.xi[1] - self.xi[0], self.eta[1] - self.eta[0]);
        let share = |a: f64, b: f64| match (a < 0.0, b < 0.0) {
            (true, true) => 1.0,
            (false, false) => 0.0,
            _ if a.is_infinite() || b.is_infinite() => 0.5,
            (inside, _) => {
                let root = a / (a - b);
                if inside { root } else { 1.0 - root }
            }
        };
        let column = |i: usize| (1..m).map(|j| share(self.at(i, j - 1), self.at(i, j))).sum::<f64>() * dy;
        (0..n).map(|i| column(i) * dx * if i == 0 || i + 1 == n { 0.5 } else { 1.0 }).sum()
    }

    /// What the area may miss beside the ends of a surface, where s does not pass δ between two points of a column \[mm²\].
    fn beside_ends(&self) -> f64 {
        let (m, cell) = (self.eta.len(), (self.xi[1] - self.xi[0]) * (self.eta[1] - self.eta[0]));
        let at_end = |pair: &[f64]| pair[0].min(pair[1]) < 0.0 && pair[0].max(pair[1]).is_infinite();
        let ends = self.depth.chunks(m).flat_map(|column| column.windows(2)).filter(|pair| at_end(pair));
        0.5 * cell * ends.count() as f64
    }

    /// The box around the points inside of a region, and two points and a quarter of it more: the tips between its lines. `None`
    /// without such points.
    fn inside(&self, window: &Window, region: impl Fn(f64, f64) -> bool) -> Option<Window> {
        let m = self.eta.len();
        let inside = |k: &usize| self.depth[*k] < 0.0 && region(self.xi[k / m], self.eta[k % m]);
        let points: Vec<usize> = (0..self.depth.len()).filter(inside).collect();
        let around = |axis: &[f64], index: &dyn Fn(usize) -> usize, most: Interval| {
            let at = points.iter().map(|k| index(*k));
            let [first, last] = at.fold([usize::MAX, 0], |[p, q], k| [p.min(k), q.max(k)]);
            let more = 2.0 * (axis[1] - axis[0]) + 0.25 * (axis[last] - axis[first]);
            Interval::new(axis[first], axis[last]).grown(more).cut(most)
        };
        (!points.is_empty()).then(|| Window {
            xi: around(&self.xi, &|k| k / m, window.xi),
            eta: around(&self.eta, &|k| k % m, window.eta),
        })
    }

    /// Number of parts of the points inside, where neighbours are four, and where they are eight: runs of points inside of neighbouring
    /// columns are joined where they meet, of eight also where their ends are one point apart.
    fn parts(&self) -> [usize; 2] {
        let columns: Vec<Vec<[usize; 2]>> = self.depth.chunks(self.eta.len()).map(runs_inside).collect();
        [0, 1].map(|corner| {
            let mut parts = 0;
            // The run with which a run was joined; its own number if with none.
            let mut joined: Vec<usize> = Vec::new();
            let mut before = 0;
            for (i, runs) in columns.iter().enumerate() {
                let begin = joined.len();
                joined.extend(begin..begin + runs.len());
                parts += runs.len();
                let mut k = 0;
                for (number, &[low, high]) in runs.iter().enumerate().filter(|_| i > 0) {
                    let last = &columns[i - 1];
                    k += last[k..].iter().take_while(|run| run[1] + corner < low).count();
                    for other in (k..last.len()).take_while(|&other| last[other][0] <= high + corner) {
                        let [a, b] =
                            [before + other, begin + number].map(|run| first_joined(&mut joined, run));
                        parts -= usize::from(a != b);
                        joined[b] = a;
                    }
                }
                before = begin;
            }
            parts
        })
    }

    /// Whether a point on the window's edge is inside.
    fn touches_the_edge(&self) -> bool {
        let (n, m) = (self.xi.len(), self.eta.len());
        let ends = |i: usize| self.at(i, 0) < 0.0 || self.at(i, m - 1) < 0.0;
        (0..n).any(ends) || (0..m).any(|j| self.at(0, j) < 0.0 || self.at(n - 1, j) < 0.0)
    }
}

/// The first and last point of every run of points inside of a column.
fn runs_inside(column: &[f64]) -> Vec<[usize; 2]> {
    let mut end = 0;
    let alike = column.chunk_by(|a, b| (*a < 0.0) == (*b < 0.0)).map(|run| {
        end += run.len();
        (run[0] < 0.0, [end - run.len(), end - 1])
    });
    alike.filter(|(inside, _)| *inside).map(|(_, run)| run).collect()
}

/// The run for which all that were joined with a run stand.
fn first_joined(joined: &mut [usize], mut run: usize) -> usize {
    while joined[run] != run {
        joined[run] = joined[joined[run]];
        run = joined[run];
    }
    run
}

/// Every point of the grid, judged by the patch's slices.
fn check_points(case: &Case, patch: &Patch, filled: &Filled) {
    for (i, &xi) in filled.xi.iter().enumerate() {
        let slices = patch.slices(xi);
        for (j, &eta) in filled.eta.iter().enumerate() {
            let depth = filled.at(i, j);
            let found = slices.iter().any(|(_, slice)| slice.eta.contains(eta));
            let sure = depth.abs() > DOUBTFUL && depth.is_finite();
            // Where a body ends a point may round off it.
            let beside = |slice: &Interval| slice.ends().iter().any(|edge| (edge - eta).abs() < 1e-6);
            assert!(
                found == (depth < 0.0) || !sure || slices.iter().any(|(_, slice)| beside(&slice.eta)),
                "{}: s − δ = {depth:e} at ({xi}, {eta}), {slices:?}",
                case.name
            );
        }
    }
}

/// What the fill of a case has left open.
#[derive(Debug, Default, Clone, Copy)]
pub struct Open {
    cases: usize,
    connection: usize,
    edge: usize,
    area: usize,
}

/// What a fill of such cells \[mm\] may miss of the area beside the ends of a component along ξ that are ends of a surface \[mm²\].
fn beside_profile_ends(patch: &Patch, cell: f64) -> f64 {
    let ends = |c: &Component| c.ends.iter().filter(|end| **end == End::ProfileEnd).count();
    patch.components.iter().map(|c| 0.5 * cell * c.eta.width() * ends(c) as f64).sum()
}

/// Every point, the components, the area and the cuts of a patch against fills.
pub fn check(case: &Case) -> Open {
    let in_time = InTime::begin();
    let patch = Patch::new(&case.placement, case.approach, &case.window);
    drop(in_time);
    let mut n = POINTS[0];
    let mut before = case.filled(&case.window, n);
    check_points(case, &patch, &before);
    let mut open = Open { cases: 1, ..Open::default() };
    loop {
        n *= 2;
        let filled = case.filled(&case.window, n);
        let (area, change) = (filled.area(), (filled.area() - before.area()).abs());
        let near = (patch.area() - area).abs() <= AREA * area + 2.0 * change;
        let parts = filled.parts();
        let connected = parts == [patch.components.len(); 2];
        let cut = patch.cut_by_window() == filled.touches_the_edge();
        let fine = change <= 0.5 * AREA * area;
        if near && connected && cut && fine {
            return open;
        }
        if n >= POINTS[1] {
            let cell = filled.xi[1] - filled.xi[0];
            let cells = cell * (filled.eta[1] - filled.eta[0]);
            let closer = |finer: usize| {
                let (fills, mut change) = case.closer(&filled, &patch, finer);
                let area = area_of(&fills);
                let sum = |[a, b]: [usize; 2], [c, d]: [usize; 2]| [a + c, b + d];
                let parts = fills.iter().map(Filled::parts).fold([0; 2], sum);
                let fine = change <= 0.5 * AREA * area;
                change += fills.iter().map(Filled::beside_ends).sum::<f64>();
                ([area, change], fine, parts)
            };
            let agrees = |&([area, change], ..): &([f64; 2], bool, [usize; 2])| {
                let unsure = 2.0 * change + beside_profile_ends(&patch, cell);
                (patch.area() - area).abs() <= AREA * area + unsure
            };
            // Two coarse grids may agree by chance.
            let known = near && fine;
            let mut found = if known { ([area, change], true, parts) } else { closer(1) };
            if !agrees(&found) {
                found = closer(FINER);
            }
            let ([area, change], fine, closer) = found;
            assert!(agrees(&found), "{}: area {}, by the fill {area} ± {change}", case.name, patch.area());
            // A part that is thinner than a cell is one by its corners only.
            let count = patch.components.len();
            let connected = connected || (closer[1] <= count && count <= closer[0]);
            // What is smaller than some cells the fill may not see.
            let seen = patch.components.iter().filter(|c| c.area > 100.0 * cells).count();
            assert!(
                connected || parts[0] >= seen || parts[1] <= patch.components.len(),
                "{}: {} components, {parts:?} by the fill",
                case.name,
                patch.components.len()
            );
            assert!(
                patch.cut_by_window() || !filled.touches_the_edge(),
                "{}: not cut by the window, and points on its edge are inside",
                case.name
            );
            open.connection = usize::from(!connected);
            open.edge = usize::from(!cut);
            open.area = usize::from(!fine);
            if !connected {
                println!("{}: {} components, {parts:?} by the fill", case.name, patch.components.len());
            }
            return open;
        }
        before = filled;
    }
}

/// An automatic grid has a ring of s > δ around it, or of points without a surface; and the whole patch's components are those
/// of its window.
fn check_rings(case: &Case) {
    let whole = Patch::new(&case.placement, case.approach, &Window::UNBOUNDED);
    for group in mesh::groups(&whole, 0.0, None) {
        let axes = group.axes(None).expect("axes");
        let (n, m) = (axes.xi.len(), axes.eta.len());
        let depth = case.depths(&axes.xi, &axes.eta);
        for (k, depth) in depth.iter().enumerate() {
            let (i, j) = (k / m, k % m);
            let ring = i == 0 || j == 0 || i + 1 == n || j + 1 == m;
            assert!(
                !ring || *depth > -DOUBTFUL,
                "{}: s − δ = {depth:e} on the ring, at ({}, {}) of {group:?}",
                case.name,
                axes.xi[i],
                axes.eta[j]
            );
        }
    }
}

/// Checks the cases of all numbers below `count` that there are; fails with the names of those that fail, and of those in `known`
/// that do not: these are defects that are not mended yet.
pub fn check_all(
    count: u64,
    known: &[&str],
    case: impl Fn(u64) -> Option<Case> + Sync,
    check: impl Fn(&Case) -> Open + Sync + std::panic::RefUnwindSafe,
) {
    println!("cases 0 … {count}");
    let failed = std::sync::Mutex::new(Vec::new());
    let sum = |a: Open, b: Open| Open {
        cases: a.cases + b.cases,
        connection: a.connection + b.connection,
        edge: a.edge + b.edge,
        area: a.area + b.area,
    };
    let one = |number: u64| {
        let Some(case) = case(number) else { return Open::default() };
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| check(&case)));
        if outcome.is_err() != known.contains(&case.name.as_str()) {
            failed.lock().expect("a list").push(case.name.clone());
        }
        outcome.unwrap_or(Open { cases: 1, ..Open::default() })
    };
    let open = (0..count).into_par_iter().map(one).reduce(Open::default, sum);
    println!("left open: {open:?}");
    let failed = failed.into_inner().expect("a list");
    assert!(
        failed.is_empty(),
        "{} of {} failed, or no longer do:\n{}",
        failed.len(),
        open.cases,
        failed.join("\n")
    );
    assert!(open.cases as f64 > 0.7 * count as f64, "only {} pairs meet", open.cases);
    assert!((open.connection as f64) <= UNDECIDED * count as f64, "{open:?}");
}

#[test]
fn patches_are_what_a_flood_fill_finds() {
    let count = std::env::var("WHEELRAIL_PATCHES").ok().and_then(|count| count.parse().ok()).unwrap_or(PAIRS);
    check_all(count, &[], Case::new, |case| {
        check_rings(case);
        check(case)
    });
}
