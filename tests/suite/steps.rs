//! Wide grids over steps and ends of the wheel's outer surface: every method against brute force in space.
//!
//! `WHEELRAIL_CAMPAIGN=2000 cargo test steps -- --nocapture` is the long run.

use rayon::prelude::*;
use wheelrail::case::{Part, Run, SILENT};
use wheelrail::internal::{Random, missing_for_report_newton};
use wheelrail::placement::Placement;
use wheelrail::scene;
use wheelrail::separation::{EtaAxis, Evaluator, FULL_PRECISION, Method, plan};

use crate::campaign;
use crate::common::repository;
use crate::conformal_brute::oracle::{Line, Revolved};
use crate::conformal_brute::placements::{KINDS, Placed, Stock};
use crate::in_time::InTime;

/// Largest difference of s at single points from brute force \[mm\].
const DIFFERENCE: f64 = 1e-6;

/// Distance \[mm\] from a step or end of the surface within which rounding decides on which side a point lies.
const AT_STEP: f64 = 1e-7;

/// Number of points of a grid that are compared with brute force: anywhere, and at most so many beside jumps of s.
const ANYWHERE: usize = 24;
const BESIDE_JUMPS: usize = 24;

/// Jump \[mm\] of s between neighbouring points of a column beyond which the surface may step between them.
const JUMP: f64 = 0.5;

/// Times by which a line is followed more finely where s disagrees: a corner of the wheel may lie within one step.
const FINER: f64 = 100.0;

/// A grid over a placed pair.
struct Grid {
    name: String,
    placement: Placement,
    xi: Vec<f64>,
    axis: EtaAxis,
}

impl Grid {
    /// A wide grid over a placed pair, or a few columns.
    fn random(placed: Placed, dice: &mut Random) -> Self {
        let widest = 120f64.min(0.6 * placed.placement.wheel_radius());
        let mut axis = |most: usize| {
            let half = widest.min(10f64.powf(dice.between(0.7, 2.1)));
            let centre = if dice.below(2) == 0 { 0.0 } else { dice.between(half - widest, widest - half) };
            let most = if dice.below(4) == 0 { 8 } else { most };
            let n = 1 + dice.below(most);
            let even = dice.below(3) > 0;
            let mut all: Vec<f64> = (0..n)
                .map(|k| if even { (2 * k + 1) as f64 / n as f64 - 1.0 } else { dice.between(-1.0, 1.0) })
                .map(|share| centre + half * share)
                .collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let (xi, eta) = (axis(96), axis(48));
        // Half the wheels are not skewed: their columns are polynomials in η².
        let plain = dice.below(2) == 0;
        let placement = if plain { placed.placement.without_skew() } else { placed.placement };
        let name = format!("{}{}", placed.name, if plain { ", not skewed" } else { "" });
        Self { name, placement, xi, axis: EtaAxis::new(&eta) }
    }

    fn place(&self, k: usize) -> [f64; 2] {
        [self.xi[k / self.axis.eta().len()], self.axis.eta()[k % self.axis.eta().len()]]
    }

    /// s at single points \[mm\].
    fn exact(&self) -> Vec<f64> {
        let mut evaluator = Evaluator::new(&self.placement);
        let points = self.xi.len() * self.axis.eta().len();
        (0..points).map(|k| self.place(k)).map(|[xi, eta]| evaluator.separation(xi, eta)).collect()
    }

    /// Fills the grid by a method: s and the estimate of its error \[mm\].
    fn filled(&self, method: Option<Method>, tolerance: f64) -> (Vec<f64>, f64) {
        let mut plan = plan(&self.placement, &self.xi, &self.axis, tolerance, method);
        let mut s = vec![0.0; self.xi.len() * self.axis.eta().len()];
        s.fill(f64::INFINITY);
        plan.fill(&self.placement, &self.xi, &self.axis, &mut s);
        (s, plan.error)
    }

    /// Every method that has formulas for the pair.
    fn methods(&self) -> Vec<Option<Method>> {
        let smooth = self.placement.rail().is_smooth() && self.placement.wheel().is_smooth();
        let has = |method: &Method| match method {
            Method::Quadratic => smooth,
            Method::ReportNewton => missing_for_report_newton(&self.placement).is_none(),
            _ => true,
        };
        let forced = Method::ALL.into_iter().filter(has).map(Some);
        forced.chain([None]).collect()
    }

    /// Says where a method has a number that single points do not have or the reverse, or is off by more than its estimate.
    fn wrong(&self, method: Option<Method>, tolerance: f64, exact: &[f64]) -> Option<String> {
        let (s, estimate) = self.filled(method, tolerance);
        let (_, rounding) = self.filled(Some(Method::Pointwise), FULL_PRECISION);
        let right =
            |s: f64, exact: f64| s.is_nan() && exact.is_nan() || (s - exact).abs() <= estimate + rounding;
        let bad = (0..s.len()).filter(|&k| !right(s[k], exact[k]));
        let worst =
            bad.clone().max_by(|&a, &b| (s[a] - exact[a]).abs().total_cmp(&(s[b] - exact[b]).abs()))?;
        let name = method.map_or("auto", Method::name);
        let (found, is, place) = (s[worst], exact[worst], self.place(worst));
        Some(format!(
            "{name} to {tolerance:e} mm, estimate {estimate:e}: {} of {} points, worst {found} for {is} at {place:?}",
            bad.count(),
            s.len(),
        ))
    }

    /// Indices of points for brute force.
    fn picked(&self, exact: &[f64], dice: &mut Random) -> Vec<usize> {
        let count = self.axis.eta().len();
        let jumps = |k: usize| {
            let next = exact[k + 1];
            k % count + 1 < count && (exact[k].is_nan() != next.is_nan() || (exact[k] - next).abs() > JUMP)
        };
        let beside: Vec<usize> =
            (0..exact.len() - 1).filter(|&k| jumps(k)).flat_map(|k| [k, k + 1]).collect();
        let few = beside.len().min(BESIDE_JUMPS);
        let mut picked: Vec<usize> = (0..few).map(|_| *dice.pick(&beside)).collect();
        picked.extend((0..ANYWHERE).map(|_| dice.below(exact.len())));
        picked
    }
}

/// s by brute force \[mm\]: the first entry into the wheel of a line along ζ, above the rail; NaN where a body has no surface.
fn brute(placement: &Placement, wheel: &Revolved<'_>, [xi, eta]: [f64; 2], finer: f64) -> f64 {
    let zeta = placement.rail().section().height(xi);
    if zeta.is_nan() {
        return f64::NAN;
    }
    let line = Line { from: [xi, eta, zeta], normal: [0.0, 1.0] };
    wheel.first_entry(&line, finer).unwrap_or(f64::NAN)
}

/// Whether s is that of brute force at a place, or next to it beside a step or end.
fn agrees(grid: &Grid, wheel: &Revolved<'_>, place: [f64; 2], s: f64) -> bool {
    let same = |exact: f64| s.is_nan() && exact.is_nan() || (s - exact).abs() <= DIFFERENCE;
    let moved = |[along, across]: [f64; 2]| [place[0] + along, place[1] + across];
    let around = [[0.0, 0.0], [AT_STEP, 0.0], [-AT_STEP, 0.0], [0.0, AT_STEP], [0.0, -AT_STEP]];
    same(brute(&grid.placement, wheel, place, 1.0))
        || around.into_iter().any(|by| same(brute(&grid.placement, wheel, moved(by), FINER)))
}

/// What was compared.
#[derive(Default)]
struct Tally {
    grids: usize,
    points: usize,
    hits: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn of(grid: &Grid, dice: &mut Random) -> Self {
        let (exact, wheel) = (grid.exact(), Revolved::new(&grid.placement));
        let picked = grid.picked(&exact, dice);
        let mut tally = Self { grids: 1, points: picked.len(), ..Self::default() };
        for k in picked {
            tally.hits += usize::from(!exact[k].is_nan());
            if !agrees(grid, &wheel, grid.place(k), exact[k]) {
                let found = brute(&grid.placement, &wheel, grid.place(k), FINER);
                tally.wrong.push(format!(
                    "{}: a point {} for {found} at {:?}",
                    grid.name,
                    exact[k],
                    grid.place(k)
                ));
            }
        }
        let tolerance = *dice.pick(&[FULL_PRECISION, 1e-9, 1e-6]);
        let methods = grid.methods();
        let wrong = methods.into_iter().filter_map(|method| grid.wrong(method, tolerance, &exact));
        tally.wrong.extend(wrong.map(|wrong| format!("{}: {wrong}", grid.name)));
        tally
    }

    fn joined(mut self, other: Self) -> Self {
        self.grids += other.grids;
        self.points += other.points;
        self.hits += other.hits;
        self.wrong.extend(other.wrong);
        self
    }

    fn is_right(&self) {
        let wrong = &self.wrong;
        assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
    }
}

#[test]
fn every_method_knows_steps_and_ends_of_random_scenes() {
    let stock = Stock::new();
    let mut all = Tally::default();
    for (kind, name) in KINDS.iter().enumerate() {
        let grids = (0..campaign::scenes()).into_par_iter().flat_map_iter(|seed| {
            let mut dice = Random::new(seed);
            stock.placed(kind, seed).into_iter().map(move |placed| {
                let _in_time = InTime::begin();
                let grid = Grid::random(placed, &mut dice);
                Tally::of(&grid, &mut dice)
            })
        });
        let tally = grids.reduce(Tally::default, Tally::joined);
        let Tally { grids, points, hits, wrong } = &tally;
        println!(
            "{name}: {grids} grids, {points} points by brute force, {hits} on both bodies, {} wrong",
            wrong.len()
        );
        assert!(3 * hits > *points, "{name}: too few points on the bodies");
        all = all.joined(tally);
    }
    all.is_right();
}

/// Computes a scene of `tests/defects` by a method; `None` leaves the scene's own.
fn part(name: &str, method: Option<Method>) -> Part {
    let folder = repository("tests/defects");
    let mut scene = scene::load(&folder.join(name)).unwrap();
    scene.grid.method = method.or(scene.grid.method);
    let run = Run::new(scene::resolve(&scene, &folder, name).unwrap(), SILENT).unwrap();
    let warned = run.warnings();
    assert!(!warned.iter().any(|warning| warning.contains("NaN")), "{name}: {warned:?}");
    run.parts.into_iter().next().unwrap()
}

/// The grid of a computed scene.
fn grid_of(name: &str, part: &Part) -> Grid {
    let (axes, placement) = (&part.site.grid, part.site.contact.placement.clone());
    Grid { name: name.into(), placement, xi: axes.xi.clone(), axis: EtaAxis::new(&axes.eta) }
}

#[test]
fn scenes_that_went_wrong_behind_steps_are_right() {
    let scenes = [
        "spectral-above-estimate.json",
        "spectral-behind-step-1.json",
        "spectral-behind-step-2.json",
        "spectral-behind-step-3.json",
        "spectral-behind-step-minimal.json",
        "spectral-silent.json",
        "spectral-worst-18mm.json",
    ];
    for name in scenes {
        let grid = grid_of(name, &part(name, None));
        Tally::of(&grid, &mut Random::new(0)).is_right();
    }
}

#[test]
fn every_method_says_alike_where_a_body_has_no_surface() {
    for name in ["masks-tread.json", "masks-flange.json"] {
        let missing = |method| {
            let part = part(name, Some(method));
            part.analysis.separation.iter().map(|s| s.is_nan()).collect::<Vec<_>>()
        };
        let exact = missing(Method::Pointwise);
        assert!(exact.contains(&true) && exact.contains(&false), "{name}");
        for method in Method::ALL {
            assert!(missing(method) == exact, "{name}: {}", method.name());
        }
    }
}
